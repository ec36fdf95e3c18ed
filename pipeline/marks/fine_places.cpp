#include "pipeline/marks/fine_places.h"

#include <cassert>
#include <cmath>

#include <glm/common.hpp>

namespace pleinair::marks {
namespace {

/// From the square between brows and chin to the whole face, in its sides.
constexpr double kHalfWidth = 0.46;
constexpr double kHalfHeight = 0.65;
constexpr double kLower = 0.06;
/// Widths in marks, up to which faces need finer ones wholly, and from which on they do by
/// kLeastNeed.
constexpr double kSmallMarks = 24.0;
constexpr double kLargeMarks = 60.0;
constexpr double kLeastNeed = 0.35;

}  // namespace

void FinePlaces::add(glm::vec2 px, glm::vec2 radiiPx, float share) {
  assert(count_ < kMaxPlaces && radiiPx.x > 0.0F && radiiPx.y > 0.0F);
  places_.at(count_) = glm::vec4(px, 1.0F / radiiPx);
  shares_.at(count_ / 4)[static_cast<int>(count_ % 4)] = share;
  ++count_;
}

void FinePlaces::bind(gpu::Program& program) const {
  program.set("finePlaces", places_)
      .set("fineShares", shares_)
      .set("finePlaceCount", static_cast<int>(count_));
}

FinePlaces finePlacesOfFaces(const scene::ArFrame& frame, double amount, double markPx) {
  FinePlaces places;
  if (!frame.measuredFaces || amount <= 0.0) return places;
  const scene::MeasuredFaces& measured = *frame.measuredFaces;
  for (const tracking::Face& face : measured.faces) {
    if (places.count() == FinePlaces::kMaxPlaces) break;
    const glm::dvec2 px = (face.px - measured.frameOrigin) / measured.frameScale;
    const glm::dvec2 side = face.sidePx / measured.frameScale;
    const double large = glm::smoothstep(kSmallMarks, kLargeMarks, side.x / markPx);
    const double need = glm::mix(1.0, kLeastNeed, large);
    places.add(px + glm::dvec2(0.0, kLower * side.y), side * glm::dvec2(kHalfWidth, kHalfHeight),
               static_cast<float>(amount * need * face.presence));
  }
  return places;
}

}  // namespace pleinair::marks
