#pragma once

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

namespace pleinair::scene {

/// A vector that follows another, noisy one smoothly, and rests on a still scene: what is shown
/// stays put until the smoothed vector has left a band around it, then goes along until they meet.
class SteadyVector {
 public:
  /// `share`: of the way to `target` that is gone at once, 0 … 1; the first target is taken whole.
  void follow(const glm::dvec3& target, double share, double band) {
    if (!hasValue_) {
      smoothed_ = shown_ = target;
      hasValue_ = true;
      return;
    }
    smoothed_ += share * (target - smoothed_);
    const double apart = glm::distance(smoothed_, shown_);
    isMoving_ = apart > (isMoving_ ? 0.25 * band : band);
    if (isMoving_) shown_ += share * (smoothed_ - shown_);
  }
  void forget() { *this = {}; }

  bool hasValue() const { return hasValue_; }
  const glm::dvec3& value() const { return shown_; }

 private:
  glm::dvec3 smoothed_{0.0};
  glm::dvec3 shown_{0.0};
  bool hasValue_ = false;
  bool isMoving_ = false;
};

}  // namespace pleinair::scene
