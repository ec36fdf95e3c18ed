#include "hal/cameras/synthetic/render/light_changes.h"

#include <cmath>

namespace pleinair::hal::synthetic {
namespace {

constexpr double kOnSeconds = 1;
constexpr double kOffSeconds = 2.5;
constexpr double kFallSeconds = 4;
constexpr double kLowestSeconds = 6;
constexpr double kFallenBy = 0.25;

/// Frame times are rounded to nanoseconds: frame 30 of 30 a second counts as at 1 s.
double inLoop(double seconds) {
  constexpr double kRoundingSeconds = 1e-5;
  const double t = seconds + kRoundingSeconds;
  return t - kLightsSeconds * std::floor(t / kLightsSeconds);
}

}  // namespace

bool isSpotlightOn(SyntheticShot shot, double seconds) {
  if (shot != SyntheticShot::kLights) return false;
  const double t = inLoop(seconds);
  return t >= kOnSeconds && t < kOffSeconds;
}

double exposureGain(SyntheticShot shot, double seconds) {
  if (shot != SyntheticShot::kLights) return 1;
  const double t = inLoop(seconds);
  if (t < kFallSeconds) return 1;
  const double half = kLowestSeconds - kFallSeconds;
  return 1 - kFallenBy * (1 - std::abs(t - kLowestSeconds) / half);
}

}  // namespace pleinair::hal::synthetic
