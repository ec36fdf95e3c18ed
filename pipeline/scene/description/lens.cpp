#include "pipeline/scene/description/lens.h"

#include <algorithm>
#include <array>

namespace pleinair::scene {

bool bendsLines(const tracking::Distortion& d) {
  return std::ranges::any_of(std::array{d.k1, d.k2, d.p1, d.p2, d.k3, d.k4, d.k5, d.k6},
                             [](double term) { return term != 0.0; });
}

double trustedLensRadius(const tracking::Distortion& d) {
  constexpr int kSteps = 1024;
  constexpr double kStep = kMaxTrustedRadius / kSteps;
  constexpr double kMinGrowth = 0.05;  // growth of the distorted radius relative to the true one
  double before = 0.0;
  for (int step = 1; step <= kSteps; ++step) {
    const double radius = step * kStep;
    const double r2 = radius * radius;
    const double below = 1.0 + r2 * (d.k4 + r2 * (d.k5 + r2 * d.k6));
    const double distorted = radius * (1.0 + r2 * (d.k1 + r2 * (d.k2 + r2 * d.k3))) / below;
    if (!(below > 0.0) || !(distorted - before > kMinGrowth * kStep)) return radius - kStep;
    before = distorted;
  }
  return kMaxTrustedRadius;
}

}  // namespace pleinair::scene
