#include "hal/media/srgb_profile.h"

#include <algorithm>
#include <array>
#include <new>

#include <lcms2.h>

namespace pleinair::hal {
namespace {

std::vector<std::uint8_t> makeSrgbProfile() {
  void* const profile = cmsCreate_sRGBProfile();
  if (profile == nullptr) throw std::bad_alloc();
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::vector<std::uint8_t> bytes(size);
  const bool isSaved = cmsSaveProfileToMem(profile, bytes.data(), &size) != 0;
  cmsCloseProfile(profile);
  if (!isSaved) throw std::bad_alloc();
  // The date of creation (ICC.1:2010 §7.2.8), which lcms2 takes from the clock: 2000-01-01 00:00.
  constexpr std::size_t kDateOffset = 24;
  constexpr std::array<std::uint8_t, 12> kDate{0x07, 0xD0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 0};
  if (bytes.size() >= kDateOffset + kDate.size()) {
    std::ranges::copy(kDate, bytes.begin() + kDateOffset);
  }
  return bytes;
}

}  // namespace

const std::vector<std::uint8_t>& srgbProfile() {
  static const std::vector<std::uint8_t> kProfile = makeSrgbProfile();
  return kProfile;
}

}  // namespace pleinair::hal
