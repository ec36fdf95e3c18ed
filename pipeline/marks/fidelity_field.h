#pragma once

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// Where an image is depicted more faithfully than elsewhere, such as in faces: by more, smaller
/// and shorter marks of truer colours (shaders/fidelity.glsl). A value.
class FidelityField {
 public:
  static constexpr std::size_t kMaxPlaces = 8;  // as in shaders/fidelity.glsl

  /// An upright ellipse, px of the full image, 1.4 times as high as it is wide, that fades out
  /// beyond its border. `fidelity` in [0, 1]. Precondition: fewer than kMaxPlaces places.
  void add(glm::vec2 px, float halfWidthPx, float fidelity);
  std::size_t count() const { return count_; }
  /// How much area has full fidelity, or more has less: px² of the full image.
  float areaPx() const { return areaPx_; }

  /// Sets the inputs of shaders/fidelity.glsl. Precondition: the program is in use.
  void bind(gpu::Program& program) const;

 private:
  std::array<glm::vec4, kMaxPlaces> places_{};  // px, 1 / half the width, fidelity
  std::size_t count_ = 0;
  float areaPx_ = 0.0F;
};

/// That of the frame's faces: `amount`, in [0, 1], where they are up to 24 of the finest marks
/// wide, falling to about a third of it at 60, which show their features anyway. `markPx`: the
/// width of the finest marks, px of the full image.
FidelityField fidelityOfFaces(const scene::ArFrame& frame, double amount, double markPx);

}  // namespace pleinair::marks
