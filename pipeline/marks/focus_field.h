#pragma once

#include <cstddef>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>

#include "pipeline/gpu/programs/program.h"

namespace pleinair::marks {

/// Where an image is painted finely, and how much more broadly elsewhere: a target of density for
/// each place (shaders/focus.glsl). Without places, the same everywhere. A value.
class FocusField {
 public:
  static constexpr std::size_t kMaxPlaces = 4;

  /// A disc, px of the full image, that fades out over `falloffPx` beyond its radius. `strength` in
  /// [0, 1]; that of the strongest place holds for all. Precondition: fewer than kMaxPlaces places.
  void add(glm::vec2 px, float radiusPx, float falloffPx, float strength);
  std::size_t count() const { return count_; }
  float strength() const { return strength_; }

  /// Sets the inputs of shaders/focus.glsl. Precondition: the program is in use.
  void bind(gpu::Program& program) const;

 private:
  glm::mat4 places_{0.0F};  // a column each: px, radius, falloff; falloff 0: none
  std::size_t count_ = 0;
  float strength_ = 0.0F;
};

}  // namespace pleinair::marks
