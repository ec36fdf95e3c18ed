#include "tests/reports/tracking/pose_measures.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/pose/twist.h"

namespace pleinair::tracking {
namespace {

std::vector<TagMarker> markersOf(const TruthSequence& sequence, Layout layout) {
  std::vector<TagMarker> markers = sequence.markers;
  if (layout == Layout::kLoose) {
    for (TagMarker& marker : markers) marker.worldFromTag.reset();
  }
  return markers;
}

ModelPx truePx(const TruthSequence& sequence, std::size_t frame, int id) {
  const TagMarker& marker = sequence.marker(id);
  return modelPx(sequence.camera, sequence.frames[frame].cameraFromWorld * *marker.worldFromTag,
                 marker.edgeMetres);
}

std::optional<ModelPx> toldPx(const TruthSequence& sequence, std::span<const TrackedPoses> told,
                              std::size_t frame, int id) {
  const auto found = told[frame].tags.find(id);
  if (found == told[frame].tags.end()) return std::nullopt;
  return modelPx(sequence.camera, *found->second.cameraFromTag, sequence.marker(id).edgeMetres);
}

/// The error of each point.
std::optional<ModelPx> errorPx(const TruthSequence& sequence, std::span<const TrackedPoses> told,
                               std::size_t frame, int id) {
  std::optional<ModelPx> error = toldPx(sequence, told, frame, id);
  if (!error) return std::nullopt;
  const ModelPx truth = truePx(sequence, frame, id);
  for (std::size_t i = 0; i < truth.size(); ++i) (*error)[i] -= truth[i];
  return error;
}

/// The mean squared distance to the true path `shiftFrames` frames earlier.
double squaredDistanceAt(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id,
                         double shiftFrames) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 2; i + 2 < told.size(); ++i) {
    const auto px = toldPx(sequence, told, i, id);
    if (!px) continue;
    const double at = static_cast<double>(i) - shiftFrames;
    const auto before = static_cast<std::size_t>(std::floor(at));
    const double part = at - std::floor(at);
    const ModelPx first = truePx(sequence, before, id);
    const ModelPx second = truePx(sequence, before + 1, id);
    for (std::size_t k = 0; k < px->size(); ++k) {
      const glm::dvec2 there = glm::mix(first[k], second[k], part);
      sum += glm::dot((*px)[k] - there, (*px)[k] - there);
    }
    ++count;
  }
  return count == 0 ? std::nan("") : sum / static_cast<double>(8 * count);
}

/// The outline of the tag with its white border, or of the right part of it.
std::vector<cv::Point> coverOf(const TagCornersPx& corners, double part) {
  constexpr double kBorder = 1.3;
  const glm::dvec2 centre = (corners[0] + corners[1] + corners[2] + corners[3]) / 4.0;
  TagCornersPx wide{};
  for (std::size_t i = 0; i < 4; ++i) wide[i] = centre + kBorder * (corners[i] - centre);
  wide[0] = glm::mix(wide[1], wide[0], part);
  wide[3] = glm::mix(wide[2], wide[3], part);
  std::vector<cv::Point> polygon;
  for (const glm::dvec2& px : wide) {
    polygon.emplace_back(static_cast<int>(std::lround(px.x)), static_cast<int>(std::lround(px.y)));
  }
  return polygon;
}

}  // namespace

std::vector<TrackedPoses> trackAll(const TruthSequence& sequence, Layout layout,
                                   const TrackerOptions& options, const Retouch& retouch) {
  Tracker tracker(sequence.camera, markersOf(sequence, layout), options);
  std::vector<TrackedPoses> all;
  hal::Image retouched;
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    const TruthFrame& frame = sequence.frames[i];
    if (retouch) {
      retouched = frame.luma;
      retouch(frame, i, retouched);
    }
    const TrackingResult result =
        tracker.track(retouch ? retouched.view() : frame.luma.view(), frame.time);
    TrackedPoses told{.cameraFromWorld = result.cameraFromWorld,
                      .worldCovariance = result.worldCovariance};
    for (const TrackedTag& tag : result.tags) {
      if (tag.cameraFromTag) told.tags[tag.id] = tag;
    }
    all.push_back(std::move(told));
  }
  return all;
}

std::array<glm::dvec3, 8> modelPoints(double edgeMetres) {
  std::array<glm::dvec3, 8> points{};
  const auto foot = tagCorners(edgeMetres);
  for (std::size_t i = 0; i < 4; ++i) {
    points[i] = foot[i];
    points[i + 4] = foot[i] - glm::dvec3(0.0, 0.0, edgeMetres);
  }
  return points;
}

ModelPx modelPx(const CameraModel& camera, const glm::dmat4& cameraFromTag, double edgeMetres) {
  ModelPx px{};
  const auto points = modelPoints(edgeMetres);
  for (std::size_t i = 0; i < points.size(); ++i) {
    px[i] = camera.project(glm::dvec3(cameraFromTag * glm::dvec4(points[i], 1.0)));
  }
  return px;
}

double rmsBetween(const ModelPx& a, const ModelPx& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += glm::dot(a[i] - b[i], a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

ModelError modelError(const TruthSequence& sequence, std::size_t frame, int id,
                      const glm::dmat4& cameraFromTag) {
  const TagMarker& marker = sequence.marker(id);
  const glm::dmat4 truth = sequence.frames[frame].cameraFromWorld * *marker.worldFromTag;
  return {
      .rotationDegrees = glm::degrees(rotationBetweenRad(cameraFromTag, truth)),
      .translationMm = 1000.0 * glm::distance(glm::dvec3(cameraFromTag[3]), glm::dvec3(truth[3])),
      .px = rmsBetween(modelPx(sequence.camera, cameraFromTag, marker.edgeMetres),
                       modelPx(sequence.camera, truth, marker.edgeMetres))};
}

PredictedErrors predictedErrors(const TruthSequence& sequence, std::span<const TrackedPoses> told,
                                PoseSource source) {
  double actual = 0.0;
  double predicted = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < told.size(); ++i) {
    for (const auto& [id, tag] : told[i].tags) {
      if (!sequence.frames[i].visible.contains(id) || tag.source != source) continue;
      const double px = modelError(sequence, i, id, *tag.cameraFromTag).px;
      actual += px * px;
      predicted += projectedVariancePx(sequence.camera, *tag.cameraFromTag, tag.covariance,
                                       modelPoints(sequence.marker(id).edgeMetres));
      count += 1.0;
    }
  }
  return {.actualPx = std::sqrt(actual / count), .predictedPx = std::sqrt(predicted / count)};
}

double percentile(std::vector<double> values, double part) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

double rootMeanSquare(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return values.empty() ? std::nan("") : std::sqrt(sum / static_cast<double>(values.size()));
}

Tremble trembleOf(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id,
                  std::size_t firstFrame) {
  std::vector<ModelPx> seen;
  std::vector<double> steps;
  ModelPx mean{};
  for (std::size_t i = firstFrame; i < told.size(); ++i) {
    const auto px = toldPx(sequence, told, i, id);
    if (!px) continue;
    if (!seen.empty()) steps.push_back(rmsBetween(*px, seen.back()));
    for (std::size_t k = 0; k < px->size(); ++k) mean[k] += (*px)[k];
    seen.push_back(*px);
  }
  for (glm::dvec2& px : mean) px /= static_cast<double>(seen.size());
  std::vector<double> offsets;
  offsets.reserve(seen.size());
  for (const ModelPx& px : seen) offsets.push_back(rmsBetween(px, mean));
  return {.aboutMean = rootMeanSquare(offsets), .frameToFrame = rootMeanSquare(steps)};
}

double lagMs(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id) {
  constexpr double kStep = 0.02;  // frames
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (int step = -75; step <= 75; ++step) {
    const double shift = kStep * step;
    const double distance = squaredDistanceAt(sequence, told, id, shift);
    if (distance < least) {
      least = distance;
      best = shift;
    }
  }
  const std::chrono::duration<double, std::milli> length =
      sequence.frames.back().time - sequence.frames.front().time;
  return best * length.count() / static_cast<double>(sequence.frames.size() - 1);
}

Retouch hidden(const Hiding& hiding, std::optional<int> onlyId) {
  return [hiding, onlyId](const TruthFrame& frame, std::size_t index, hal::Image& luma) {
    if (!hiding.hides(index)) return;
    cv::Mat picture(luma.size().height, luma.size().width, CV_8UC1, luma.plane(0).data());
    for (const auto& [id, corners] : frame.corners) {
      if (onlyId && id != *onlyId) continue;
      cv::fillConvexPoly(picture, coverOf(corners, hiding.part), cv::Scalar(128));
    }
  };
}

HiddenResult hiddenResult(const TruthSequence& sequence, std::span<const TrackedPoses> told, int id,
                          const Hiding& hiding) {
  constexpr std::size_t kAfter = 10;
  HiddenResult out;
  for (std::size_t begin = hiding.firstFrame;
       begin + hiding.hiddenFrames + kAfter < sequence.frames.size(); begin += hiding.everyFrames) {
    const std::size_t end = begin + hiding.hiddenFrames;
    bool wasVisible = true;
    for (std::size_t i = begin - 1; i <= end + kAfter; ++i) {
      wasVisible = wasVisible && sequence.frames[i].visible.contains(id);
    }
    const auto before = errorPx(sequence, told, begin - 1, id);
    if (!wasVisible || !before) continue;
    ++out.times;
    double drift = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      ++out.framesHidden;
      const auto error = errorPx(sequence, told, i, id);
      if (!error) {
        ++out.framesLost;
      } else {
        drift = std::max(drift, rmsBetween(*error, *before));
      }
    }
    out.driftPx.push_back(drift);
    double jump = 0.0;
    for (std::size_t i = end; i < end + 6; ++i) {
      const auto last = errorPx(sequence, told, i - 1, id);
      const auto now = errorPx(sequence, told, i, id);
      if (last && now) jump = std::max(jump, rmsBetween(*last, *now));
    }
    out.jumpPx.push_back(jump);
    const auto after = errorPx(sequence, told, end + kAfter, id);
    out.settlePx.push_back(after ? rmsBetween(*after, ModelPx{}) : std::nan(""));
  }
  return out;
}

}  // namespace pleinair::tracking
