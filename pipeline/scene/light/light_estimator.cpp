#include "pipeline/scene/light/light_estimator.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include "pipeline/scene/description/scene.h"

namespace pleinair::scene {
namespace {

constexpr double kLevelSeconds = 0.1;
constexpr double kKeySeconds = 3.0;
constexpr double kForgottenSeconds = 0.5;
constexpr double kLevelBand = 0.012;  // relative to the level; noise moves a tag's mean by 0.003
constexpr double kKeyBand = 0.04;     // relative to the light on the plane; 2 to 3 degrees
constexpr double kKeyShare = 0.68;    // of the light on the plane, where nothing is known
constexpr double kGreyWorld = 0.25;   // assumed mean reflectance of the scene
// Part of the light reflected by the plane that reaches models from below.
constexpr double kReflected = 0.7;
/// In the camera's frame.
constexpr glm::dvec3 kDefaultTowardKey{-0.45, -0.45, -0.77};
constexpr double kPriorSeconds = 1.0;
constexpr double kMinKeyHeight = 0.25;  // sine of its height over the plane

double luminance(const glm::dvec3& linearRgb) {
  return luminanceOf(glm::vec3(linearRgb));
}

double shareAfter(double seconds, double constantSeconds) {
  return 1.0 - std::exp(-seconds / constantSeconds);
}

/// The rotation of the camera's frame to that of `attach`.
glm::dmat3 fromCamera(const glm::dmat4& cameraFromAttach) {
  return glm::transpose(glm::dmat3(cameraFromAttach));
}

/// The direction, raised if it is too close to the plane for a light on it.
glm::dvec3 raised(const glm::dvec3& toward) {
  const double length = glm::length(toward);
  if (!(length > 1e-9)) return {0.0, 0.0, 1.0};
  const glm::dvec3 unit = toward / length;
  if (unit.z >= kMinKeyHeight) return unit;
  const double across = std::hypot(unit.x, unit.y);
  if (!(across > 1e-9)) return {0.0, 0.0, 1.0};
  const double flat = std::sqrt(1.0 - kMinKeyHeight * kMinKeyHeight) / across;
  return {flat * unit.x, flat * unit.y, kMinKeyHeight};
}

/// Key and ambient light of one channel for a known direction: fitLight()'s equations with the
/// direction given, so that each channel of coloured light gets its own values.
glm::dvec2 fitChannel(std::span<const LightSample> samples, const glm::dvec3& towardKey,
                      const glm::dvec2& prior) {
  constexpr double kPrecision = 1.0 / (0.15 * 0.15);
  constexpr double kOfSample = 1.0 / (0.10 * 0.10);
  glm::dmat2 equations(kPrecision, 0.0, 0.0, kPrecision);
  glm::dvec2 right = kPrecision * prior;
  for (const LightSample& sample : samples) {
    const glm::dvec2 row(1.0, std::max(0.0, glm::dot(sample.normal, towardKey)));
    equations += sample.weight * kOfSample * glm::outerProduct(row, row);
    right += sample.weight * kOfSample * sample.irradiance * row;
  }
  return glm::max(glm::inverse(equations) * right, glm::dvec2(0.05));
}

}  // namespace

LightEstimator::LightEstimator(std::span<const tracking::TagMarker> markers,
                               std::string_view tagFamily,
                               std::span<const std::optional<int>> places,
                               const std::optional<glm::dvec3>& towardKey)
    : markers_(markers.begin(), markers.end()),
      cells_(cellsAlongEdge(tagFamily)),
      towardKey_(towardKey) {
  if (towardKey_) towardKey_ = raised(*towardKey_);
  for (const std::optional<int>& tagId : places) {
    if (std::ranges::find(places_, tagId, &Place::tagId) != places_.end()) continue;
    Place& place = places_.emplace_back();
    place.tagId = tagId;
    const auto marker = std::ranges::find_if(
        markers_, [&](const tracking::TagMarker& each) { return tagId == each.id; });
    if (marker != markers_.end()) place.worldFromTag = marker->worldFromTag;
  }
  for (const Place& place : places_) lights_.push_back({.tagId = place.tagId});
  readings_.reserve(markers_.size());
  samples_.reserve(markers_.size());
}

void LightEstimator::reset() {
  lastTime_.reset();
  for (Place& place : places_) {
    Place fresh;
    fresh.tagId = place.tagId;
    fresh.worldFromTag = place.worldFromTag;
    place = fresh;
  }
  for (PlaceLighting& each : lights_) each.light = {};
}

LightEstimator::Step LightEstimator::stepTo(hal::TimePoint captureTime) {
  Step step;
  if (lastTime_) {
    step.seconds = hal::toSeconds(captureTime - *lastTime_);
    step.isFirst = step.seconds < 0.0 || step.seconds > kForgottenSeconds;
    step.seconds = std::clamp(step.seconds, 0.0, kForgottenSeconds);
  }
  lastTime_ = captureTime;
  return step;
}

void LightEstimator::follow(const hal::ImageView& image, const tracking::TrackingResult& tracked,
                            hal::TimePoint captureTime) {
  const Step step = stepTo(captureTime);
  const LinearImage picture(image);
  statistics_ = imageStatistics(picture);
  readPapers(picture, tracked);
  for (std::size_t i = 0; i < places_.size(); ++i) {
    Place& place = places_[i];
    std::optional<glm::dmat3> attachFromCamera;
    const auto seen = std::ranges::find_if(tracked.tags, [&](const tracking::TrackedTag& tag) {
      return place.tagId == tag.id && tag.cameraFromTag;
    });
    if (seen != tracked.tags.end()) {
      attachFromCamera = fromCamera(*seen->cameraFromTag * kTagFromAttach);
    } else if (tracked.cameraFromWorld && (!place.tagId || place.worldFromTag)) {
      attachFromCamera =
          fromCamera(*tracked.cameraFromWorld *
                     (place.tagId ? *place.worldFromTag * kTagFromAttach : glm::dmat4(1.0)));
    }
    const std::optional<glm::dvec3> white = followLevel(place, attachFromCamera, step);
    if (white && attachFromCamera) {
      followPrior(place, *attachFromCamera, step);
      followKey(place, *white, *attachFromCamera, step);
    }
    lights_[i].light = composed(place);
  }
}

void LightEstimator::readPapers(const LinearImage& picture,
                                const tracking::TrackingResult& tracked) {
  readings_.clear();
  if (!cells_) return;
  for (const tracking::TrackedTag& tag : tracked.tags) {
    // for a carried tag, the image may show something else
    if (!tag.cameraFromTag || tag.source == tracking::PoseSource::kCarried) continue;
    if (readings_.size() == readings_.capacity()) break;
    const auto paper = readTagPaper(picture, tag.corners, *cells_);
    if (!paper) continue;
    const glm::dmat4 cameraFromAttach = *tag.cameraFromTag * kTagFromAttach;
    readings_.push_back(
        {.id = tag.id, .cameraNormal = glm::dvec3(cameraFromAttach[2]), .paper = *paper});
  }
}

const LightEstimator::Reading* LightEstimator::paperOf(const Place& place) const {
  if (!place.tagId) return nullptr;
  const auto own = std::ranges::find(readings_, *place.tagId, &Reading::id);
  return own == readings_.end() ? nullptr : &*own;
}

/// The level of white paper that is parallel to the place.
std::optional<glm::dvec3> LightEstimator::whiteFacing(const glm::dmat3& attachFromCamera) const {
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (const Reading& reading : readings_) {
    const double facing = std::max(0.0, (attachFromCamera * reading.cameraNormal).z);
    const double weight = double{reading.paper.confidence} * std::pow(facing, 8.0);
    sum += weight * glm::dvec3(reading.paper.white);
    weights += weight;
  }
  constexpr double kMinWeight = 0.02;
  if (weights < kMinWeight) return std::nullopt;
  return sum / weights;
}

/// Updates the level. Returns the white level for relating other light to, if any paper was read.
std::optional<glm::dvec3> LightEstimator::followLevel(
    Place& place, const std::optional<glm::dmat3>& attachFromCamera, const Step& step) {
  if (step.isFirst) place.level.forget();
  std::optional<glm::dvec3> white;
  if (const Reading* own = paperOf(place)) {
    white = glm::dvec3(own->paper.white);
    place.hasOwnPaper = true;
  } else if (!place.hasOwnPaper && attachFromCamera) {
    white = whiteFacing(*attachFromCamera);
  }
  if (white) place.ofMean = *white / statistics_.mean;
  const bool isKnown = place.ofMean != glm::dvec3(0.0);
  const glm::dvec3 grey(luminance(statistics_.mean) / kGreyWorld);
  const glm::dvec3 target = isKnown ? place.ofMean * statistics_.mean : glm::min(grey, 1.0);
  place.level.follow(target, shareAfter(step.seconds, kLevelSeconds),
                     kLevelBand * glm::length(target));
  return white;
}

/// Takes the prior in the first second in which the place is seen, then keeps it, so that it does
/// not turn with the camera.
void LightEstimator::followPrior(Place& place, const glm::dmat3& attachFromCamera,
                                 const Step& step) const {
  if (towardKey_) {
    place.towardPrior = *towardKey_;
    return;
  }
  if (place.seconds > kPriorSeconds) return;
  glm::dvec3 toward = kDefaultTowardKey;
  constexpr double kConvincing = 0.25;  // part of the variance
  if (statistics_.explained > kConvincing) {
    toward +=
        0.5 * statistics_.explained * glm::clamp(glm::dvec3(statistics_.slope, 0.0), -1.5, 1.5);
  }
  const glm::dvec3 now = raised(attachFromCamera * toward);
  const bool isFirst = place.towardPrior == glm::dvec3(0.0);
  const double share = isFirst ? 1.0 : step.seconds / (place.seconds + step.seconds + 1e-3);
  place.towardPrior = raised(glm::mix(place.towardPrior, now, share));
}

void LightEstimator::followKey(Place& place, const glm::dvec3& white,
                               const glm::dmat3& attachFromCamera, const Step& step) {
  const double level = luminance(white);
  samples_.clear();
  for (const Reading& reading : readings_) {
    // Differences to the plane's own light are limited to a factor of three.
    const double relative = std::clamp(luminanceOf(reading.paper.white) / level, 1.0 / 3.0, 3.0);
    samples_.push_back({.normal = attachFromCamera * reading.cameraNormal,
                        .irradiance = relative,
                        .weight = double{reading.paper.confidence}});
  }
  LightFit prior;
  prior.ambient = 1.0 - kKeyShare;
  prior.keyVector = kKeyShare / std::max(place.towardPrior.z, 0.5) * place.towardPrior;
  const LightFit fit = fitLight(samples_, prior);
  const glm::dvec3 toward = towardKey_ ? *towardKey_ : raised(fit.keyVector);

  glm::dvec3 key(0.0), sky(0.0);
  const glm::dvec2 even(fit.ambient, glm::length(fit.keyVector));
  for (int c = 0; c < 3; ++c) {
    std::size_t i = 0;
    for (const Reading& reading : readings_) {
      samples_[i++].irradiance =
          std::clamp(double{reading.paper.white[c]} / white[c], 1.0 / 3.0, 3.0);
    }
    const glm::dvec2 channel = fitChannel(samples_, toward, even);
    sky[c] = channel.x;
    key[c] = channel.y;
  }
  const glm::dvec3 reflected = glm::clamp(statistics_.mean / white, 0.05, 0.8);

  place.seconds = std::min(place.seconds + step.seconds, kKeySeconds);
  const double share = place.seconds > 0.0 ? std::max(shareAfter(step.seconds, kKeySeconds),
                                                      std::min(step.seconds / place.seconds, 0.5))
                                           : 1.0;
  place.keyVector.follow(glm::length(fit.keyVector) * toward, share, kKeyBand);
  place.key.follow(key, share, kKeyBand);
  place.sky.follow(sky, share, kKeyBand);
  place.ground.follow(kReflected * reflected, share, kKeyBand);
}

Lighting LightEstimator::composed(const Place& place) const {
  Lighting light;
  const glm::dvec3 white = place.level.value();
  light.white = glm::vec3(white);
  light.bandsAllLight = true;
  if (!place.keyVector.hasValue()) {
    const glm::dvec3 toward = towardKey_.value_or(glm::dvec3(0.0, 0.0, 1.0));
    light.towardKey = glm::vec3(toward);
    light.key = glm::vec3(kKeyShare / toward.z * white);
    light.sky = glm::vec3((1.0 - kKeyShare) * white);
    light.ground = glm::vec3(kReflected * kGreyWorld * white);
    return light;
  }
  const glm::dvec3 toward = raised(place.keyVector.value());
  const glm::dvec3 onPlane = place.sky.value() + toward.z * place.key.value();
  light.towardKey = glm::vec3(toward);
  light.key = glm::vec3(white * place.key.value() / onPlane);
  light.sky = glm::vec3(white * place.sky.value() / onPlane);
  light.ground = glm::vec3(white * place.ground.value());
  return light;
}

}  // namespace pleinair::scene
