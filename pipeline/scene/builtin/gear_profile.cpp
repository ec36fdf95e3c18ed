#include "pipeline/scene/builtin/gear_profile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace pleinair::scene {
namespace {

constexpr double kAddendum = 1.0;  // in modules, as all below
constexpr double kDedendum = 1.25;
constexpr double kThinnestTip = 0.3;
constexpr int kFilletSegments = 4;
constexpr int kFlankSegments = 6;
constexpr int kTipSegments = 3;
constexpr int kRootSegments = 2;

double involute(double angleRad) {
  return std::tan(angleRad) - angleRad;
}

/// A point by angle and radius.
struct Polar {
  double angleRad;
  double radius;
};

glm::dvec2 toPlane(const Polar& p) {
  return {p.radius * std::cos(p.angleRad), p.radius * std::sin(p.angleRad)};
}

/// The outline from the centre of the root circle's fillet to the tip, on the side of positive
/// angles, for a tooth at angle 0.
std::vector<Polar> halfTooth(const ToothForm& form, const GearRadii& radii) {
  // The fillet stays in the clearance, which the teeth of another gear do not reach.
  const double filletHeight = (kDedendum - kAddendum) * form.moduleMetres;
  const double filletTop = radii.rootMetres + filletHeight;
  const double footAngle = halfToothAngleRad(form, radii.rootMetres);
  const double halfGap = std::numbers::pi / form.teeth - footAngle;
  const double filletWidth = std::min(filletHeight / radii.rootMetres, 0.6 * halfGap);
  const Polar foot{footAngle + filletWidth, radii.rootMetres};
  const Polar top{halfToothAngleRad(form, filletTop), filletTop};

  std::vector<Polar> half;
  for (int i = 0; i < kFilletSegments; ++i) {  // a quadratic curve, tangent to circle and flank
    const double t = static_cast<double>(i) / kFilletSegments;
    const double a = (1.0 - t) * (1.0 - t);
    const double b = 2.0 * t * (1.0 - t);
    half.push_back({a * foot.angleRad + b * footAngle + t * t * top.angleRad,
                    a * foot.radius + b * radii.rootMetres + t * t * top.radius});
  }
  for (int i = 0; i <= kFlankSegments; ++i) {
    const double radius =
        filletTop + (radii.tipMetres - filletTop) * static_cast<double>(i) / kFlankSegments;
    half.push_back({halfToothAngleRad(form, radius), radius});
  }
  return half;
}

}  // namespace

double halfToothAngleRad(const ToothForm& form, double radiusMetres) {
  const double pitch = 0.5 * form.teeth * form.moduleMetres;
  const double cosine = std::min(1.0, pitch * std::cos(form.pressureAngleRad) / radiusMetres);
  return std::numbers::pi / (2.0 * form.teeth) + involute(form.pressureAngleRad) -
         involute(std::acos(cosine));
}

GearRadii gearRadii(const ToothForm& form) {
  const double m = form.moduleMetres;
  GearRadii radii;
  radii.pitchMetres = 0.5 * form.teeth * m;
  radii.baseMetres = radii.pitchMetres * std::cos(form.pressureAngleRad);
  radii.rootMetres = radii.pitchMetres - kDedendum * m;
  const auto tipIsThin = [&](double radius) {
    return 2.0 * radius * halfToothAngleRad(form, radius) < kThinnestTip * m;
  };
  double low = radii.pitchMetres;
  double high = radii.pitchMetres + kAddendum * m;
  radii.tipMetres = high;
  if (tipIsThin(high)) {
    while (high - low > 1e-6 * m) {
      const double middle = 0.5 * (low + high);
      (tipIsThin(middle) ? high : low) = middle;
    }
    radii.tipMetres = low;
  }
  return radii;
}

GearProfile gearProfile(const ToothForm& form) {
  assert(form.teeth >= 4 && form.moduleMetres > 0.0);
  const GearRadii radii = gearRadii(form);
  const std::vector<Polar> half = halfTooth(form, radii);
  std::vector<Polar> tooth;
  tooth.reserve(2 * half.size() + kTipSegments + kRootSegments);
  for (const Polar& p : half) tooth.push_back({-p.angleRad, p.radius});
  for (int i = 1; i < kTipSegments; ++i) {
    const double t = 2.0 * i / kTipSegments - 1.0;
    tooth.push_back({t * half.back().angleRad, radii.tipMetres});
  }
  for (auto p = half.rbegin(); p != half.rend(); ++p) tooth.push_back(*p);

  GearProfile profile;
  profile.toothPoints = tooth.size();
  const double pitchAngle = 2.0 * std::numbers::pi / form.teeth;
  const double rootStart = half.front().angleRad;
  for (int i = 1; i < kRootSegments; ++i) {
    const double t = static_cast<double>(i) / kRootSegments;
    tooth.push_back({rootStart + t * (pitchAngle - 2.0 * rootStart), radii.rootMetres});
  }
  profile.pointsPerTooth = tooth.size();
  profile.points.reserve(static_cast<std::size_t>(form.teeth) * tooth.size());
  for (int k = 0; k < form.teeth; ++k) {
    for (const Polar& p : tooth) {
      profile.points.push_back(toPlane({p.angleRad + k * pitchAngle, p.radius}));
    }
  }
  return profile;
}

}  // namespace pleinair::scene
