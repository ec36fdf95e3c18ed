#include "pipeline/tracking/world_pose.h"

#include <algorithm>
#include <cmath>

#include <glm/matrix.hpp>

#include "pipeline/tracking/tag_pose.h"

namespace pleinair::tracking {
namespace {

/// A tag further than this from where the others put it counts no more than this in a hypothesis'
/// score, and is left out of the solution (RMS over its corners).
constexpr double kContradictionPx = 4.0;
constexpr double kHuberPx = 1.5;
/// Hypotheses nearer to each other than this are the same solution.
constexpr double kSamePoseRad = 0.03;

struct Hypothesis {
  glm::dmat4 cameraFromWorld{1.0};
  double score = 0.0;  // px²
};

using TagPoints = std::array<Correspondence, 4>;

TagPoints worldPoints(const WorldTag& tag) {
  TagPoints points = tagCorrespondences(tag.corners, tag.edgeMetres);
  for (Correspondence& point : points) {
    point.target = glm::dvec3(tag.worldFromTag * glm::dvec4(point.target, 1.0));
  }
  return points;
}

double rmsPx(const CameraModel& camera, const TagPoints& points, const glm::dmat4& pose) {
  return std::sqrt(squaredErrorPx(camera, points, pose) / static_cast<double>(points.size()));
}

/// All tags' poses as the camera's, best first.
std::vector<Hypothesis> hypotheses(const CameraModel& camera, std::span<const WorldTag> tags,
                                   std::span<const TagPoints> points) {
  std::vector<Hypothesis> all;
  for (const WorldTag& tag : tags) {
    for (const PoseEstimate& candidate : tag.candidates) {
      Hypothesis hypothesis{.cameraFromWorld =
                                candidate.cameraFromTarget * glm::inverse(tag.worldFromTag)};
      for (const TagPoints& each : points) {
        const double rms = rmsPx(camera, each, hypothesis.cameraFromWorld);
        hypothesis.score += std::min(rms * rms, kContradictionPx * kContradictionPx);
      }
      all.push_back(hypothesis);
    }
  }
  std::ranges::sort(all, {}, &Hypothesis::score);
  return all;
}

struct Solution {
  PoseEstimate estimate;
  std::vector<bool> agrees;
  double squaredErrorPx = 0.0;
};

/// Which tags are where the pose puts them.
std::vector<bool> agreement(const CameraModel& camera, std::span<const TagPoints> points,
                            const glm::dmat4& pose) {
  std::vector<bool> agrees;
  for (const TagPoints& each : points) {
    agrees.push_back(rmsPx(camera, each, pose) <= kContradictionPx);
  }
  return agrees;
}

std::vector<Correspondence> pointsOf(std::span<const TagPoints> points,
                                     const std::vector<bool>& used) {
  std::vector<Correspondence> all;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (used[i]) all.insert(all.end(), points[i].begin(), points[i].end());
  }
  return all;
}

/// Refines over the tags that agree, and once more over those that then do.
std::optional<Solution> refine(const CameraModel& camera, std::span<const TagPoints> points,
                               const glm::dmat4& start) {
  Solution solution{.agrees = agreement(camera, points, start)};
  glm::dmat4 pose = start;
  for (int round = 0; round < 2; ++round) {
    const std::vector<Correspondence> used = pointsOf(points, solution.agrees);
    const std::optional<PoseEstimate> refined = refinePose(camera, used, pose, kHuberPx);
    if (!refined) return std::nullopt;
    solution.estimate = *refined;
    pose = refined->cameraFromTarget;
    solution.squaredErrorPx = squaredErrorPx(camera, used, pose);
    std::vector<bool> agrees = agreement(camera, points, pose);
    if (agrees == solution.agrees) break;
    solution.agrees = std::move(agrees);
  }
  return solution;
}

}  // namespace

std::optional<WorldPose> solveWorldPose(const CameraModel& camera, std::span<const WorldTag> tags,
                                        const std::optional<PosePrior>& prior) {
  std::vector<TagPoints> points;
  for (const WorldTag& tag : tags) points.push_back(worldPoints(tag));
  std::vector<Solution> solutions;
  for (const Hypothesis& hypothesis : hypotheses(camera, tags, points)) {
    if (solutions.size() == 2) break;
    const auto isKnown = [&](const Solution& other) {
      return rotationBetweenRad(other.estimate.cameraFromTarget, hypothesis.cameraFromWorld) <
             kSamePoseRad;
    };
    if (std::ranges::any_of(solutions, isKnown)) continue;
    std::optional<Solution> solution = refine(camera, points, hypothesis.cameraFromWorld);
    if (!solution || std::ranges::count(solution->agrees, true) == 0) continue;
    if (!solutions.empty()) {
      // Only a pose that explains as many tags can be the first one's twin.
      const bool isTwin =
          std::ranges::count(solution->agrees, true) ==
              std::ranges::count(solutions.front().agrees, true) &&
          rotationBetweenRad(solution->estimate.cameraFromTarget,
                             solutions.front().estimate.cameraFromTarget) >= kSamePoseRad;
      if (!isTwin) continue;
    }
    solutions.push_back(std::move(*solution));
  }
  if (solutions.empty()) return std::nullopt;
  std::ranges::sort(solutions, {}, &Solution::squaredErrorPx);

  std::vector<TwinCandidate> twins;
  for (const Solution& solution : solutions) {
    twins.push_back({.cameraFromTarget = solution.estimate.cameraFromTarget,
                     .squaredErrorPx = solution.squaredErrorPx});
  }
  const auto used = static_cast<double>(std::ranges::count(solutions.front().agrees, true));
  const TwinDecision decision = chooseTwin(twins, 8.0 * used - 6.0, prior);
  Solution& chosen = solutions[decision.index];
  return WorldPose{
      .estimate = chosen.estimate, .choice = decision.choice, .agrees = std::move(chosen.agrees)};
}

}  // namespace pleinair::tracking
