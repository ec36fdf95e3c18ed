#include "hal/cameras/synthetic/render/shot.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace pleinair::hal {
namespace {

constexpr std::array<std::string_view, 12> kNames{"walkaround", "pan",      "dolly",    "roll",
                                                  "still",      "occluder", "cut",      "visitors",
                                                  "lights",     "hand",     "crossing", "portrait"};

}  // namespace

std::string_view toString(SyntheticShot shot) {
  return kNames.at(static_cast<std::size_t>(shot));
}

std::optional<SyntheticShot> syntheticShotNamed(std::string_view name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) return std::nullopt;
  return static_cast<SyntheticShot>(found - kNames.begin());
}

std::span<const std::string_view> syntheticShots() {
  return kNames;
}

std::string syntheticShotNames() {
  std::string names;
  for (const std::string_view name : kNames) {
    names += names.empty() ? "" : ", ";
    names += name;
  }
  return names;
}

}  // namespace pleinair::hal
