// What moves by itself before a standing camera moves over the paper, and takes no part in it.
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "tests/gpu/watercolor/watercolor_fixture.h"

namespace pleinair::styles {
namespace {

constexpr hal::FrameSize kPicture{192, 144};
constexpr hal::FrameSize kNodes{24, 18};
constexpr double kNodePx = 8.0;
constexpr double kRadius = 44.0;
constexpr double kStepPx = 3.0;  // a frame, 75 px a second

class Gliding : public StyleTest {
 protected:
  /// How uneven a plain disc is that has come to the middle, or rests there, as seen in the
  /// last frame: the standard deviation within it, levels.
  double unevenness(bool isMoving, bool isCameraStill = true) {
    constexpr int kFrames = 9;
    Watercolor style(library_);
    style.setParameters(style.parameters().with("granulation", "1").with("grain", "0"));
    double deviation = 0.0;
    for (int number = 1; number <= kFrames; ++number) {
      const double x = 0.5 * kPicture.width + (isMoving ? kStepPx * (number - kFrames) : 0.0);
      const gpu::Texture picture = support::textureOf(discAt(x).view());
      tracking::ImageMotion motion;
      // A camera that moves by next to nothing does not stand.
      scene::ArFrame frame =
          followed(picture, number, glm::dvec2(isCameraStill ? 0.0 : 0.3, 0.0), motion);
      motion.picture->errorPx = 1.0;  // dense flow is the better source
      motion.flow = flowOfDisc(x, isMoving ? kStepPx : 0.0);
      deviation = deviationWithin(support::readRgba8(style.paint(frame, {})));
    }
    return deviation;
  }

 private:
  static hal::Image discAt(double x) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kPicture});
    for (int row = 0; row < kPicture.height; ++row) {
      for (int column = 0; column < kPicture.width; ++column) {
        const bool isDisc = std::hypot(column - x, row - 0.5 * kPicture.height) < kRadius;
        auto* const pixel = image.row(0, row).data() + std::ptrdiff_t{4} * column;
        pixel[0] = isDisc ? 70 : 200;
        pixel[1] = isDisc ? 90 : 190;
        pixel[2] = isDisc ? 140 : 170;
        pixel[3] = 255;
      }
    }
    return image;
  }

  static tracking::DenseFlow flowOfDisc(double x, double step) {
    std::vector<glm::vec4> forward;
    std::vector<glm::vec4> backward;
    for (int row = 0; row < kNodes.height; ++row) {
      for (int column = 0; column < kNodes.width; ++column) {
        const glm::dvec2 px = kNodePx * (glm::dvec2(column, row) + 0.5);
        const double away = std::hypot(px.x - x, px.y - 0.5 * kPicture.height);
        const auto moved = static_cast<float>(away < kRadius + kNodePx ? step : 0.0);
        forward.emplace_back(moved, 0.0F, 0.1F, 0.0F);
        backward.emplace_back(-moved, 0.0F, 0.1F, 0.0F);
      }
    }
    return {.nodes = kNodes,
            .stepPx = glm::vec2(static_cast<float>(kNodePx)),
            .forward = forward,
            .backward = backward};
  }

  static double deviationWithin(hal::Image painting) {
    double sum = 0.0;
    double squares = 0.0;
    double count = 0.0;
    for (int row = 0; row < kPicture.height; ++row) {
      for (int column = 0; column < kPicture.width; ++column) {
        const double away = std::hypot(column - 0.5 * kPicture.width, row - 0.5 * kPicture.height);
        if (away > kRadius - 16.0) continue;
        const double level = painting.row(0, row)[static_cast<std::size_t>(4 * column + 1)];
        sum += level;
        squares += level * level;
        count += 1.0;
      }
    }
    return std::sqrt(squares / count - (sum / count) * (sum / count));
  }
};

TEST_F(Gliding, ThePapersGrainIsNotInWhatMoves) {
  const double resting = unevenness(false);
  EXPECT_GT(resting, 6.0) << "the control: pigment settles in the paper's valleys";
  EXPECT_LT(unevenness(true), 0.35 * resting);
}

TEST_F(Gliding, NothingIsJudgedWhileTheCameraMoves) {
  EXPECT_GT(unevenness(true, false), 0.7 * unevenness(false));
}

}  // namespace
}  // namespace pleinair::styles
