#pragma once

#include <cmath>
#include <memory>
#include <random>

#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/scene/scene_shaders.h"
#include "pipeline/styles/registry.h"
#include "pipeline/styles/watercolor/watercolor.h"
#include "tests/support/gl_test.h"

namespace pleinair::styles {

/// A picture with what the passes must cope with: ramps, hard edges, saturated colours, darks,
/// noise. The same for the same arguments.
inline hal::Image testPicture(hal::FrameSize size, unsigned seed, double shiftPixels = 0.0) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
  std::mt19937 random(seed);
  for (int y = 0; y < size.height; ++y) {
    const auto row = image.row(0, y);
    for (int x = 0; x < size.width; ++x) {
      const double u = x + shiftPixels;
      const bool disc = std::hypot(u - size.width * 0.4, y - size.height * 0.5) < size.height * 0.3;
      const bool band = std::fmod(u + y * 0.5 + 1000.0, 40.0) < 9.0;
      const double colour[3] = {disc ? 220.0 : 30.0 + 150.0 * x / size.width,
                                band ? 200.0 : 20.0 + 100.0 * y / size.height,
                                disc && band ? 0.0 : 90.0};
      for (std::size_t c = 0; c < 3; ++c) {
        const double noisy = colour[c] + static_cast<double>(random() % 9U) - 4.0;
        row[static_cast<std::size_t>(x) * 4 + c] =
            static_cast<std::uint8_t>(std::clamp(noisy, 0.0, 255.0));
      }
      row[static_cast<std::size_t>(x) * 4 + 3] = 255;
    }
  }
  return image;
}

/// A context with the shaders of all styles.
class StyleTest : public support::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    library_.add(gpu::gpuShaders());
    library_.add(gpu::sceneShaders());
    library_.add(gpu::marksShaders());
    addStyleShaders(library_);
  }

  /// Frame `number` of a 25 Hz camera that sees `picture`.
  static scene::ArFrame frameOf(const gpu::Texture& picture, int number = 0) {
    return {.colour = &picture,
            .sequence = static_cast<std::uint64_t>(number),
            .captureTime = hal::TimePoint(hal::Duration(40'000'000) * number)};
  }

  /// The same of a camera that is followed: the picture has moved by `by` since frame number − 1.
  /// `motion` is to live as long.
  static scene::ArFrame followed(const gpu::Texture& picture, int number, glm::dvec2 by,
                                 tracking::ImageMotion& motion) {
    motion = {};
    motion.frameSize = picture.size();
    motion.sinceSequence = static_cast<std::uint64_t>(number - 1);
    glm::dmat3 currentFromPrevious(1.0);
    currentFromPrevious[2] = glm::dvec3(by, 1.0);
    motion.picture =
        tracking::ImageHomography{.currentFromPrevious = currentFromPrevious, .errorPx = 0.01};
    motion.noiseLevels = 2.0;
    scene::ArFrame frame = frameOf(picture, number);
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion};
    return frame;
  }

  gpu::ShaderLibrary library_;
};

}  // namespace pleinair::styles
