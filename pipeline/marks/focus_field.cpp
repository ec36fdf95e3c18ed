#include "pipeline/marks/focus_field.h"

#include <algorithm>
#include <cassert>

#include <glm/vec4.hpp>

namespace pleinair::marks {

void FocusField::add(glm::vec2 px, float radiusPx, float falloffPx, float strength) {
  constexpr float kLeastFalloff = 1.0F;
  assert(count_ < kMaxPlaces);
  places_[static_cast<int>(count_++)] = glm::vec4(px, radiusPx, std::max(falloffPx, kLeastFalloff));
  strength_ = std::max(strength_, strength);
}

void FocusField::bind(gpu::Program& program) const {
  program.set("focusPlaces", places_).set("focusStrength", strength_);
}

}  // namespace pleinair::marks
