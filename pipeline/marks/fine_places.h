#pragma once

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// Places that the finest marks of an image depict more exactly than the rest, such as faces: with
/// more, smaller and shorter marks of truer colours (shaders/fine_places.glsl). A value.
class FinePlaces {
 public:
  static constexpr std::size_t kMaxPlaces = 8;

  /// An upright ellipse, px of the full image, that fades out beyond its border. `share` in [0, 1]:
  /// how much. Precondition: fewer than kMaxPlaces places.
  void add(glm::vec2 px, glm::vec2 radiiPx, float share);
  std::size_t count() const { return count_; }

  /// Sets the inputs of shaders/fine_places.glsl. Precondition: the program is in use.
  void bind(gpu::Program& program) const;

 private:
  std::array<glm::vec4, kMaxPlaces> places_{};  // px and 1 / radii
  std::array<glm::vec4, kMaxPlaces / 4> shares_{};
  std::size_t count_ = 0;
};

/// The frame's faces, `amount` in [0, 1] as much as they need it: wholly where they are some dozen of
/// the finest marks wide, less where larger ones show their features anyway. `markPx`: the width of
/// the finest marks, px of the full image.
FinePlaces finePlacesOfFaces(const scene::ArFrame& frame, double amount, double markPx);

}  // namespace pleinair::marks
