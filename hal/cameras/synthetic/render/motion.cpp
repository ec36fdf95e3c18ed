#include "hal/cameras/synthetic/render/motion.h"

#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "hal/cameras/synthetic/render/portrait.h"
#include "hal/cameras/synthetic/render/visitors.h"
#include "hal/cameras/synthetic/world/noise.h"

namespace pleinair::hal::synthetic {
namespace {

constexpr glm::dvec3 kHomeEye{0.04, -1.14, 0.57};
constexpr glm::dvec3 kHomeTarget{0.025, 0.06, 0.150};

// Beyond the wall behind the room, which is visible from inside only: a person fits into the image.
constexpr glm::dvec3 kVisitorsEye{0.475, -4.0, 0.62};
constexpr glm::dvec3 kVisitorsTarget{0.475, -0.75, 0.02};

/// The pose of an OpenCV camera at `position` that looks at `target`, with the world's z up in the
/// image.
glm::dmat4 lookAt(glm::dvec3 position, glm::dvec3 target) {
  const glm::dvec3 z = glm::normalize(target - position);
  const glm::dvec3 x = glm::normalize(glm::cross(z, glm::dvec3(0, 0, 1)));
  const glm::dvec3 y = glm::cross(z, x);
  const glm::dmat3 worldFromCamera(x, y, z);
  glm::dmat4 cameraFromWorld(glm::transpose(worldFromCamera));
  cameraFromWorld[3] = glm::dvec4(-(glm::transpose(worldFromCamera) * position), 1);
  return cameraFromWorld;
}

double swing(double seconds, double periodSeconds) {
  return std::sin(2 * std::numbers::pi * seconds / periodSeconds);
}

/// Smooth step from 0 to 1 over `from` … `to`, with zero speed at both ends.
double eased(double value, double from, double to) {
  const double t = glm::clamp((value - from) / (to - from), 0.0, 1.0);
  return t * t * t * (t * (6 * t - 15) + 10);
}

glm::dmat4 turnedBy(const glm::dmat4& pose, double radians, glm::dvec3 axis) {
  return glm::rotate(glm::dmat4(1), radians, axis) * pose;
}

}  // namespace

SmoothNoise::SmoothNoise(std::uint64_t seed, double amplitude, double periodSeconds) {
  constexpr std::array<double, 3> kShare{0.62, 0.26, 0.12};
  constexpr std::array<double, 3> kSpeed{1.0, 1.83, 3.19};
  for (std::size_t i = 0; i < waves_.size(); ++i) {
    const double detune = 0.9 + 0.2 * unitRandom(seed, 2 * i);
    waves_[i] = {amplitude * kShare[i], 2 * std::numbers::pi * kSpeed[i] * detune / periodSeconds,
                 2 * std::numbers::pi * unitRandom(seed, 2 * i + 1)};
  }
}

double SmoothNoise::at(double seconds) const {
  double sum = 0;
  for (const Wave& wave : waves_) {
    sum += wave.amplitude * std::sin(wave.radiansPerSecond * seconds + wave.phaseRadians);
  }
  return sum;
}

Motion::Motion(SyntheticShot shot, std::uint64_t seed)
    : shot_(shot),
      targetX_(mixBits(seed) + 1, 0.09, 9.1),
      targetY_(mixBits(seed) + 2, 0.05, 7.3),
      distance_(mixBits(seed) + 3, 0.14, 11.9),
      slant_(mixBits(seed) + 4, glm::radians(6.0), 10.3),
      azimuth_(mixBits(seed) + 5, glm::radians(24.0), 11.7),
      roll_(mixBits(seed) + 6, glm::radians(2.5), 6.1),
      handShift_{SmoothNoise(mixBits(seed) + 7, 0.0012, 0.61),
                 SmoothNoise(mixBits(seed) + 8, 0.0012, 0.53),
                 SmoothNoise(mixBits(seed) + 9, 0.0012, 0.71)},
      handTurn_{SmoothNoise(mixBits(seed) + 10, glm::radians(0.14), 0.59),
                SmoothNoise(mixBits(seed) + 11, glm::radians(0.14), 0.67),
                SmoothNoise(mixBits(seed) + 12, glm::radians(0.14), 0.49)} {}

glm::dmat4 Motion::heldAt(glm::dvec3 eye, glm::dvec3 target, double seconds) const {
  const glm::dvec3 tremble(handShift_[0].at(seconds), handShift_[1].at(seconds),
                           handShift_[2].at(seconds));
  glm::dmat4 pose = lookAt(eye + tremble, target);
  pose = turnedBy(pose, handTurn_[0].at(seconds), {1, 0, 0});
  pose = turnedBy(pose, handTurn_[1].at(seconds), {0, 1, 0});
  return turnedBy(pose, roll_.at(seconds) + handTurn_[2].at(seconds), {0, 0, 1});
}

glm::dmat4 Motion::walkaround(double seconds) const {
  const glm::dvec3 target = kHomeTarget + glm::dvec3(targetX_.at(seconds), targetY_.at(seconds), 0);
  const glm::dvec3 home = kHomeEye - kHomeTarget;
  const double distance = glm::length(home) + distance_.at(seconds);
  const double slant = std::asin(home.z / glm::length(home)) + slant_.at(seconds);
  const double azimuth = azimuth_.at(seconds);
  const glm::dvec3 towardsEye(std::cos(slant) * std::sin(azimuth),
                              -std::cos(slant) * std::cos(azimuth), std::sin(slant));
  return heldAt(target + distance * towardsEye, target, seconds);
}

glm::dmat4 Motion::cut(double seconds) const {
  struct Setting {
    glm::dvec3 eye, target;
  };
  constexpr double kSecondsEach = 2;
  constexpr std::array<Setting, 3> kSettings{{{kHomeEye, kHomeTarget},
                                              {{0.20, -0.72, 0.40}, {-0.30, 0.18, 0.09}},
                                              {{-0.30, -0.95, 0.44}, {0.48, 0.16, 0.15}}}};
  const double count = std::floor(seconds / kSecondsEach);
  const Setting& setting =
      kSettings[static_cast<std::size_t>(std::fmod(count, static_cast<double>(kSettings.size())))];
  return heldAt(setting.eye, setting.target, seconds);
}

glm::dmat4 Motion::cameraFromWorld(double seconds) const {
  const glm::dmat4 home = lookAt(kHomeEye, kHomeTarget);
  switch (shot_) {
    case SyntheticShot::kWalkaround:
      return walkaround(seconds);
    case SyntheticShot::kPan:
      return turnedBy(home, glm::radians(17.0) * swing(seconds, 7), {0, 1, 0});
    case SyntheticShot::kDolly:
      return lookAt(kHomeEye + (kHomeTarget - kHomeEye) * (0.13 + 0.29 * swing(seconds, 8)),
                    kHomeTarget);
    case SyntheticShot::kRoll:
      return turnedBy(home, glm::radians(28.0) * swing(seconds, 6), {0, 0, 1});
    case SyntheticShot::kStill:
    case SyntheticShot::kLights:
    case SyntheticShot::kHand:
      return home;
    case SyntheticShot::kVisitors:
    case SyntheticShot::kCrossing:
      return lookAt(kVisitorsEye, kVisitorsTarget);
    case SyntheticShot::kPortrait:
      return lookAt(kPortraitEye, kPortraitTarget);
    case SyntheticShot::kOccluder:
      return heldAt(kHomeEye, kHomeTarget, seconds);
    case SyntheticShot::kCut:
      return cut(std::fmax(seconds, 0));
  }
  return home;
}

namespace {

constexpr glm::dvec3 kArmAway{0.62, -1.02, 0.30};  // beyond the image's corner

glm::dmat4 worldFromArm(double seconds) {
  constexpr double kPeriodSeconds = 6;
  constexpr glm::dvec3 kThere{-0.02, -0.06, 0.105};
  const double t = std::fmod(seconds + kPeriodSeconds, kPeriodSeconds);
  const double reached = eased(t, 0.5, 1.9) - eased(t, 3.2, 4.6);
  const glm::dvec3 place = glm::mix(kArmAway, kThere, reached) +
                           reached * glm::dvec3(0.035 * swing(t, 1.4), 0.03 * swing(t, 1.9), 0);
  const glm::dmat4 pose = glm::translate(glm::dmat4(1), place);
  return glm::rotate(pose, glm::radians(10.0 * swing(t, 2.3)), glm::dvec3(0, 0, 1));
}

/// It reaches over the bench, rests there for a second, goes on to another place and withdraws.
glm::dmat4 worldFromSlowArm(double seconds) {
  constexpr double kPeriodSeconds = 10;
  constexpr glm::dvec3 kFirst{0.10, -0.16, 0.115};
  constexpr glm::dvec3 kSecond{-0.14, -0.02, 0.105};
  const double t = seconds - kPeriodSeconds * std::floor(seconds / kPeriodSeconds);
  const double reached = eased(t, 0.8, 3.2) - eased(t, 6.0, 8.6);
  const double wentOn = eased(t, 4.2, 5.6);
  const glm::dvec3 place = glm::mix(kArmAway, glm::mix(kFirst, kSecond, wentOn), reached);
  const double turn = glm::radians(8.0 * reached - 14.0 * wentOn);
  return glm::rotate(glm::translate(glm::dmat4(1), place), turn, glm::dvec3(0, 0, 1));
}

}  // namespace

BodyPoses Motion::bodies(double seconds) const {
  BodyPoses bodies;
  if (shot_ == SyntheticShot::kOccluder) bodies.place(kArm, worldFromArm(seconds));
  if (shot_ == SyntheticShot::kHand) bodies.place(kArm, worldFromSlowArm(seconds));
  if (shot_ == SyntheticShot::kVisitors) placeVisitors(seconds, bodies);
  if (shot_ == SyntheticShot::kCrossing) placeCrossing(seconds, bodies);
  if (shot_ == SyntheticShot::kPortrait) placePortrait(seconds, bodies);
  return bodies;
}

}  // namespace pleinair::hal::synthetic
