#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/gpu/gpu_shaders.h"
#include "pipeline/marks/marks_shaders.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/scene/scene_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {

/// A texel of a tensor field's levels.
struct FieldTexel {
  glm::dvec2 tensor{0.0};
  double known = 0.0;
  double detail = 0.0;
};

/// Pictures that are made up, and how they moved, for the tensor field and strokes.
class TensorTest : public support::GlTest {
 protected:
  static constexpr hal::FrameSize kSize{256, 128};  // regions halve evenly to 2×1
  static constexpr hal::Duration kStep = std::chrono::milliseconds(33);

  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    library_.add(gpu::gpuShaders());
    library_.add(gpu::sceneShaders());
    library_.add(gpu::marksShaders());
  }

  /// RGBA8; `luma` in [0, 1] of a pixel's centre, with noise of `sigma` levels.
  static hal::Image greyPicture(hal::FrameSize size, const std::function<double(glm::dvec2)>& luma,
                                double sigma = 0.0, unsigned seed = 1) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = size});
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, std::max(sigma, 1e-9));
    for (int y = 0; y < size.height; ++y) {
      auto* p = image.row(0, y).data();
      for (int x = 0; x < size.width; ++x, p += 4) {
        const double level = 255.0 * luma({x + 0.5, y + 0.5}) + (sigma > 0.0 ? noise(random) : 0.0);
        p[0] = p[1] = p[2] = static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 255.0)));
        p[3] = 255;
      }
    }
    return image;
  }

  /// The next frame, whose picture moved so; valid until the next.
  scene::ArFrame frameOf(const gpu::Texture& picture, tracking::ImageMotion motion = standing(),
                         hal::Duration step = kStep) {
    motion.frameSize = picture.size();
    motion.sinceSequence = sequence_;
    motion_ = motion;
    time_ += step;
    scene::ArFrame frame{.colour = &picture, .sequence = ++sequence_, .captureTime = time_};
    frame.measuredMotion = scene::MeasuredMotion{.motion = &motion_};
    return frame;
  }

  static tracking::ImageMotion following(const glm::dmat3& currentFromPrevious) {
    return {.picture = tracking::ImageHomography{.currentFromPrevious = currentFromPrevious,
                                                 .errorPx = 0.01}};
  }
  static tracking::ImageMotion standing() { return following(glm::dmat3(1.0)); }
  /// Turns about the middle; y down, so that positive angles are clockwise.
  static glm::dmat3 rolled(double radians) {
    const double c = std::cos(radians);
    const double s = std::sin(radians);
    const glm::dvec2 m(kSize.width / 2.0, kSize.height / 2.0);
    return {c, s, 0, -s, c, 0, m.x - c * m.x + s * m.y, m.y - s * m.x - c * m.y, 1};
  }

  static std::vector<FieldTexel> read(const gpu::Texture& texture) {
    const std::vector<float> values = support::readRgba32f(texture);
    std::vector<FieldTexel> texels;
    for (std::size_t i = 0; i < values.size(); i += 4) {
      texels.push_back(
          {.tensor = {values[i], values[i + 1]}, .known = values[i + 2], .detail = values[i + 3]});
    }
    return texels;
  }

  gpu::ShaderLibrary library_;
  tracking::ImageMotion motion_;
  std::uint64_t sequence_ = 0;
  hal::TimePoint time_;
};

/// Shapes with edges in all directions, a texture, and a part without any.
inline double variedLuma(glm::dvec2 px) {
  const double disc = std::hypot(px.x - 70.0, px.y - 60.0);
  if (disc < 40.0) return 0.25 + 0.1 * std::sin(disc);
  if (px.x + 0.4 * px.y > 210.0) return 0.85;
  if (px.x > 130.0 && px.x < 170.0) return 0.5 + 0.2 * std::sin(0.5 * px.x + 0.3 * px.y);
  return 0.55;
}

}  // namespace pleinair::marks
