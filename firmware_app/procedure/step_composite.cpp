#include "firmware_app/procedure/step_composite.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/overlay/reserved_colours.h"

namespace pleinair::app {
namespace {

const cv::Vec3f kReserved(overlay::kReservedRgb[0], overlay::kReservedRgb[1],
                          overlay::kReservedRgb[2]);
const cv::Vec3b kOutline(overlay::kCasingRgb[0], overlay::kCasingRgb[1], overlay::kCasingRgb[2]);
constexpr int kOutlinePx = 3;
constexpr int kHatchPx = 12;  // from line to line
constexpr float kGhostCover = 0.45F;

float lumaOf(const cv::Vec3f& rgb) {
  return 0.299F * rgb[0] + 0.587F * rgb[1] + 0.114F * rgb[2];
}

constexpr float kTintCover = 0.4F;

cv::Vec3f pale(const cv::Vec3f& rgb) {
  const float grey = lumaOf(rgb);
  return 0.5F * cv::Vec3f(255, 255, 255) + 0.35F * cv::Vec3f(grey, grey, grey) + 0.15F * rgb;
}

/// The reserved colour with the shading of the part, which may be nearly black.
cv::Vec3f inFocus(const cv::Vec3f& rgb) {
  const float light = 0.55F + 0.6F * std::sqrt(lumaOf(rgb) / 255.0F);
  return 0.85F * light * kReserved + 0.15F * rgb;
}

void drawAround(cv::Mat3b& drawn, const cv::Mat1b& mask, const cv::Vec3b& colour, int widthPx) {
  cv::Mat1b around;
  const int side = 2 * widthPx + 1;
  cv::dilate(mask, around, cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side}));
  drawn.setTo(colour, around & ~mask);
}

}  // namespace

hal::Image stepComposite(const hal::Image& shaded, const std::vector<StepPixel>& pixels,
                         const std::vector<bool>& ghosts) {
  const hal::FrameSize size = shaded.size();
  assert(size.width % 2 == 0 && size.height % 2 == 0);
  assert(pixels.size() ==
         static_cast<std::size_t>(size.width) * static_cast<std::size_t>(size.height));
  assert(ghosts.empty() || ghosts.size() == pixels.size());
  cv::Mat3b drawn(size.height, size.width);
  cv::Mat1b focus(size.height, size.width, std::uint8_t{0});
  cv::Mat1b outlined(size.height, size.width, std::uint8_t{0});
  cv::Mat1b ghost(size.height, size.width, std::uint8_t{0});
  for (int y = 0; y < size.height; ++y) {
    const auto row = shaded.view().row(0, y);
    for (int x = 0; x < size.width; ++x) {
      const auto at = 3 * static_cast<std::size_t>(x);
      const cv::Vec3f rgb(row[at], row[at + 1], row[at + 2]);
      const std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) +
                            static_cast<std::size_t>(x);
      const StepPixel pixel = pixels[i];
      cv::Vec3f result = rgb;
      if (pixel == StepPixel::kContext || pixel == StepPixel::kOutline) result = pale(rgb);
      if (pixel == StepPixel::kTint) {
        result = (1.0F - kTintCover) * pale(rgb) + kTintCover * kReserved;
      }
      if (pixel == StepPixel::kFocus) result = inFocus(rgb);
      if (pixel == StepPixel::kFocusHidden) {
        const bool isLine = (x + y) % kHatchPx < kHatchPx / 3;
        result = isLine ? kReserved : 0.75F * pale(rgb) + 0.25F * kReserved;
      }
      if (pixel == StepPixel::kFocus || pixel == StepPixel::kFocusHidden) focus(y, x) = 255;
      if (pixel == StepPixel::kOutline) outlined(y, x) = 255;
      if (!ghosts.empty() && ghosts[i]) {
        result = (1.0F - kGhostCover) * result + kGhostCover * kReserved;
        ghost(y, x) = 255;
      }
      drawn(y, x) = cv::Vec3b(cv::saturate_cast<std::uint8_t>(result[0]),
                              cv::saturate_cast<std::uint8_t>(result[1]),
                              cv::saturate_cast<std::uint8_t>(result[2]));
    }
  }
  drawAround(drawn, outlined, cv::Vec3b(kReserved), kOutlinePx + 1);
  for (const cv::Mat1b& each : {focus, ghost}) drawAround(drawn, each, kOutline, kOutlinePx);
  hal::Image image(
      {.pixelFormat = hal::PixelFormat::kRgb8, .size = {size.width / 2, size.height / 2}});
  cv::Mat3b half(size.height / 2, size.width / 2);
  cv::resize(drawn, half, half.size(), 0.0, 0.0, cv::INTER_AREA);
  for (int y = 0; y < half.rows; ++y) {
    const auto* const from = half.ptr<std::uint8_t>(y);
    std::copy_n(from, 3 * static_cast<std::size_t>(half.cols), image.row(0, y).begin());
  }
  return image;
}

}  // namespace pleinair::app
