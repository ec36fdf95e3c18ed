#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include <glm/mat3x3.hpp>

#include "pipeline/styles/painterly/painterly.h"
#include "tests/gpu/watercolor/watercolor_fixture.h"

namespace pleinair::styles {

/// The painter over pictures whose motion the test makes up.
class PainterlyTest : public StyleTest {
 protected:
  static constexpr hal::FrameSize kSize{192, 144};
  static constexpr hal::Duration kStep = std::chrono::milliseconds(40);

  /// Frame `number` of a camera that slides over the test picture by `shiftPixels` in all; it is
  /// told of `motionPixels` since the frame before. Noise differs from frame to frame.
  scene::ArFrame next(double shiftPixels, double motionPixels, hal::FrameSize size = kSize) {
    return next(testPicture(size, 5U + static_cast<unsigned>(number_), shiftPixels), motionPixels);
  }
  scene::ArFrame next(const hal::Image& image, double motionPixels = 0.0) {
    picture_ = support::textureOf(image.view());
    motion_ = {.frameSize = image.size(), .sinceSequence = static_cast<std::uint64_t>(number_)};
    motion_.picture = tracking::ImageHomography{
        .currentFromPrevious = glm::dmat3(1, 0, 0, 0, 1, 0, -motionPixels, 0, 1), .errorPx = 0.01};
    ++number_;
    scene::ArFrame frame = frameOf(picture_, number_);
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
    return frame;
  }

  std::vector<std::uint8_t> paint(Style& style, const scene::ArFrame& frame,
                                  std::string_view view = {}) {
    return bytesOf(style.paint(frame, view));
  }
  static std::vector<std::uint8_t> bytesOf(const gpu::Texture& texture) {
    hal::Image image = support::readRgba8(texture);
    return {image.plane(0).begin(), image.plane(0).end()};
  }

  void restart() { number_ = 0; }

  gpu::Texture picture_;
  tracking::ImageMotion motion_;
  int number_ = 0;
};

/// The mean difference of two pictures' bytes, alpha not counted.
inline double meanDifference(const std::vector<std::uint8_t>& a,
                             const std::vector<std::uint8_t>& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (i % 4 != 3) sum += std::abs(int{a[i]} - int{b[i]});
  }
  return sum / (0.75 * static_cast<double>(a.size()));
}

}  // namespace pleinair::styles
