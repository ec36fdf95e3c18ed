#include "hal/media/icc_profile.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <utility>

#include <lcms2.h>

namespace pleinair::hal::libav {
namespace {

struct CloseProfile {
  void operator()(void* profile) const { cmsCloseProfile(profile); }
};
using Profile = std::unique_ptr<void, CloseProfile>;

/// Layouts of one kind of frames, in libav's and in lcms2's words.
struct Layouts {
  AVPixelFormat source;
  cmsUInt32Number sourceType;
  AVPixelFormat target;
  cmsUInt32Number targetType;
};

constexpr Layouts kGrey{AV_PIX_FMT_GRAY8, TYPE_GRAY_8, AV_PIX_FMT_RGB24, TYPE_RGB_8};
constexpr Layouts kDeepGrey{AV_PIX_FMT_GRAY16LE, TYPE_GRAY_16, AV_PIX_FMT_RGB48LE, TYPE_RGB_16};
constexpr Layouts kRgb{AV_PIX_FMT_RGB24, TYPE_RGB_8, AV_PIX_FMT_RGB24, TYPE_RGB_8};
constexpr Layouts kDeepRgb{AV_PIX_FMT_RGB48LE, TYPE_RGB_16, AV_PIX_FMT_RGB48LE, TYPE_RGB_16};
constexpr Layouts kRgba{AV_PIX_FMT_RGBA, TYPE_RGBA_8, AV_PIX_FMT_RGBA, TYPE_RGBA_8};
constexpr Layouts kDeepRgba{AV_PIX_FMT_RGBA64LE, TYPE_RGBA_16, AV_PIX_FMT_RGBA64LE, TYPE_RGBA_16};

/// Null for frames whose channels a profile of this colour space does not describe.
const Layouts* layoutsFor(const AVPixFmtDescriptor& frame, cmsColorSpaceSignature space) {
  const bool hasAlpha = (frame.flags & (AV_PIX_FMT_FLAG_ALPHA | AV_PIX_FMT_FLAG_PAL)) != 0;
  const bool isDeep = frame.comp[0].depth > 8;
  const bool isGrey =
      frame.nb_components - (hasAlpha ? 1 : 0) == 1 && (frame.flags & AV_PIX_FMT_FLAG_PAL) == 0;
  if (space == cmsSigGrayData && isGrey && !hasAlpha) return isDeep ? &kDeepGrey : &kGrey;
  if (space != cmsSigRgbData || isGrey) return nullptr;
  if (hasAlpha) return isDeep ? &kDeepRgba : &kRgba;
  return isDeep ? &kDeepRgb : &kRgb;
}

/// Whether colours come out as they went in, to within a level of 255.
bool changesNothing(cmsHPROFILE profile, cmsHPROFILE srgb, bool isGrey) {
  void* const transform = cmsCreateTransform(profile, isGrey ? TYPE_GRAY_8 : TYPE_RGB_8, srgb,
                                             TYPE_RGB_8, INTENT_PERCEPTUAL, cmsFLAGS_NOCACHE);
  if (transform == nullptr) return false;
  constexpr int kStep = 51;
  bool isSame = true;
  const auto compare = [&](std::array<std::uint8_t, 3> colour) {
    std::array<std::uint8_t, 3> shown{};
    cmsDoTransform(transform, colour.data(), shown.data(), 1);
    for (std::size_t c = 0; c < 3; ++c) {
      if (std::abs(shown.at(c) - colour.at(isGrey ? 0 : c)) > 1) isSame = false;
    }
  };
  const auto level = [](int value) { return static_cast<std::uint8_t>(value); };
  for (int r = 0; r <= 255; r += kStep) {
    for (int g = 0; g <= 255; g += kStep) {
      for (int b = 0; b <= 255; b += kStep) compare({level(r), level(g), level(b)});
    }
  }
  cmsDeleteTransform(transform);
  return isSame;
}

}  // namespace

void IccConversion::FreeTransform::operator()(void* transform) const {
  cmsDeleteTransform(transform);
}

std::optional<IccConversion> IccConversion::of(const AVFrame& frame) {
  const AVFrameSideData* const side = av_frame_get_side_data(&frame, AV_FRAME_DATA_ICC_PROFILE);
  const AVPixFmtDescriptor* const layout =
      av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
  const bool isHdr =
      frame.color_trc == AVCOL_TRC_SMPTE2084 || frame.color_trc == AVCOL_TRC_ARIB_STD_B67;
  if (side == nullptr || layout == nullptr || isHdr) return std::nullopt;
  const Profile profile(
      cmsOpenProfileFromMem(side->data, static_cast<cmsUInt32Number>(side->size)));
  if (profile == nullptr) return std::nullopt;
  const Layouts* const layouts = layoutsFor(*layout, cmsGetColorSpace(profile.get()));
  if (layouts == nullptr) return std::nullopt;
  const Profile srgb(cmsCreate_sRGBProfile());
  if (srgb == nullptr) throw std::bad_alloc();
  const bool isGrey = cmsGetColorSpace(profile.get()) == cmsSigGrayData;
  if (changesNothing(profile.get(), srgb.get(), isGrey)) return std::nullopt;
  IccConversion conversion;
  conversion.transform_.reset(cmsCreateTransform(profile.get(), layouts->sourceType, srgb.get(),
                                                 layouts->targetType, INTENT_PERCEPTUAL,
                                                 cmsFLAGS_COPY_ALPHA));
  if (conversion.transform_ == nullptr) return std::nullopt;
  conversion.source_ = layouts->source;
  conversion.target_ = layouts->target;
  return conversion;
}

void IccConversion::apply(const AVFrame& source, AVFrame& target) const {
  cmsDoTransformLineStride(
      transform_.get(), source.data[0], target.data[0], static_cast<cmsUInt32Number>(source.width),
      static_cast<cmsUInt32Number>(source.height), static_cast<cmsUInt32Number>(source.linesize[0]),
      static_cast<cmsUInt32Number>(target.linesize[0]), 0, 0);
}

}  // namespace pleinair::hal::libav
