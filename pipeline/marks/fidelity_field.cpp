#include "pipeline/marks/fidelity_field.h"

#include <cassert>
#include <numbers>

#include <glm/common.hpp>

namespace pleinair::marks {
namespace {

constexpr float kAspect = 1.4F;  // as in shaders/fidelity.glsl
/// From the square between brows and chin to the whole face, in its sides.
constexpr double kHalfWidth = 0.46;
constexpr double kLower = 0.06;
/// Widths in marks, and the least share.
constexpr double kSmallMarks = 24.0;
constexpr double kLargeMarks = 60.0;
constexpr double kLeastShare = 0.35;
static_assert(tracking::kMaxFaces <= FidelityField::kMaxPlaces);

}  // namespace

void FidelityField::add(glm::vec2 px, float halfWidthPx, float fidelity) {
  assert(count_ < kMaxPlaces && halfWidthPx > 0.0F);
  places_.at(count_++) = glm::vec4(px, 1.0F / halfWidthPx, fidelity);
  areaPx_ += std::numbers::pi_v<float> * kAspect * halfWidthPx * halfWidthPx * fidelity;
}

void FidelityField::bind(gpu::Program& program) const {
  program.set("fidelityPlaces", places_).set("fidelityCount", static_cast<int>(count_));
}

FidelityField fidelityOfFaces(const scene::ArFrame& frame, double amount, double markPx) {
  FidelityField field;
  if (!frame.measuredFaces || amount <= 0.0) return field;
  const scene::MeasuredFaces& measured = *frame.measuredFaces;
  for (const tracking::Face& face : measured.faces) {
    const double side = face.sidePx / measured.frameScale.x;
    const glm::dvec2 centre = (face.centre - measured.frameOrigin) / measured.frameScale;
    const double large = glm::smoothstep(kSmallMarks, kLargeMarks, side / markPx);
    field.add(centre + glm::dvec2(0.0, kLower * side), static_cast<float>(kHalfWidth * side),
              static_cast<float>(amount * face.presence * glm::mix(1.0, kLeastShare, large)));
  }
  return field;
}

}  // namespace pleinair::marks
