#include "pipeline/tracking/world_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include <glm/matrix.hpp>

#include "pipeline/tracking/tag_pose.h"

namespace pleinair::tracking {
namespace {

/// A tag whose corners are further than this (RMS) from where the others put it contradicts them,
/// and is left out of the solution.
constexpr double kContradictionPx = 4.0;
/// One small tag's own pose is good for no more than this at the other end of the picture. Further
/// away, a tag counts no more than this in a hypothesis' score.
constexpr double kHypothesisPx = 12.0;
constexpr double kHuberPx = 1.5;
/// Hypotheses nearer to each other than this are the same solution.
constexpr double kSamePoseRad = 0.03;
constexpr int kMaxRounds = 8;
/// Hypotheses that are refined, the best first: two are wanted, and a contradicting tag's come in
/// between.
constexpr int kMaxRefined = 8;

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
        hypothesis.score += std::min(rms * rms, kHypothesisPx * kHypothesisPx);
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

  std::ptrdiff_t agreeing() const { return std::ranges::count(agrees, true); }
};

/// Which tags are where the pose puts them, to so many pixels.
std::vector<bool> agreement(const CameraModel& camera, std::span<const TagPoints> points,
                            const glm::dmat4& pose, double tolerancePx) {
  std::vector<bool> agrees;
  for (const TagPoints& each : points) agrees.push_back(rmsPx(camera, each, pose) <= tolerancePx);
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

/// Refines over the tags that agree with the start, and again over those that then do, until these
/// are the same. Nothing where the last of them are lost on the way.
std::optional<Solution> refineFrom(const CameraModel& camera, std::span<const TagPoints> points,
                                   const glm::dmat4& start, double tolerancePx) {
  Solution solution{.agrees = agreement(camera, points, start, tolerancePx)};
  glm::dmat4 pose = start;
  for (int round = 0; round < kMaxRounds; ++round) {
    const std::vector<Correspondence> used = pointsOf(points, solution.agrees);
    const std::optional<PoseEstimate> refined = refinePose(camera, used, pose, kHuberPx);
    if (!refined) return std::nullopt;
    solution.estimate = *refined;
    pose = refined->cameraFromTarget;
    solution.squaredErrorPx = squaredErrorPx(camera, used, pose);
    std::vector<bool> agrees = agreement(camera, points, pose, kContradictionPx);
    if (agrees == solution.agrees) return solution;
    if (round + 1 < kMaxRounds) solution.agrees = std::move(agrees);
  }
  return solution;
}

/// With a wide tolerance all sound tags come in although the hypothesis is crude, but a moved one
/// may bend the pose until none agrees; the narrow one lets tags in one after another.
std::optional<Solution> refine(const CameraModel& camera, std::span<const TagPoints> points,
                               const glm::dmat4& start) {
  std::optional<Solution> wide = refineFrom(camera, points, start, kHypothesisPx);
  if (wide && wide->agreeing() == std::ssize(points)) return wide;
  std::optional<Solution> narrow = refineFrom(camera, points, start, kContradictionPx);
  if (!wide || !narrow) return wide ? wide : narrow;
  return wide->agreeing() > narrow->agreeing() ? wide : narrow;
}

/// Whether it can be the other's twin: it explains as many tags by a pose turned otherwise.
bool isTwin(const Solution& solution, const Solution& other) {
  return solution.agreeing() == other.agreeing() &&
         rotationBetweenRad(solution.estimate.cameraFromTarget, other.estimate.cameraFromTarget) >=
             kSamePoseRad;
}

/// The solution that explains most tags, and its twin if there is one; the better fit first.
std::vector<Solution> solve(const CameraModel& camera, std::span<const WorldTag> tags,
                            std::span<const TagPoints> points) {
  std::vector<Solution> solutions;
  int refinedCount = 0;
  for (const Hypothesis& hypothesis : hypotheses(camera, tags, points)) {
    if (solutions.size() == 2 || refinedCount == kMaxRefined) break;
    const auto isKnown = [&](const Solution& other) {
      return rotationBetweenRad(other.estimate.cameraFromTarget, hypothesis.cameraFromWorld) <
             kSamePoseRad;
    };
    if (std::ranges::any_of(solutions, isKnown)) continue;
    ++refinedCount;
    std::optional<Solution> solution = refine(camera, points, hypothesis.cameraFromWorld);
    if (!solution) continue;
    if (solutions.empty() || solution->agreeing() > solutions.front().agreeing()) {
      solutions.clear();
      solutions.push_back(std::move(*solution));
    } else if (isTwin(*solution, solutions.front())) {
      solutions.push_back(std::move(*solution));
    }
  }
  std::ranges::sort(solutions, {}, &Solution::squaredErrorPx);
  return solutions;
}

/// Errors over different tags do not say which solution is right: such two stay ambiguous.
std::vector<TwinCandidate> asTwins(std::span<const Solution> solutions) {
  const Solution& first = solutions.front();
  std::vector<TwinCandidate> twins;
  twins.reserve(solutions.size());
  for (const Solution& each : solutions) {
    const bool isComparable = each.agrees == first.agrees;
    twins.push_back({.cameraFromTarget = each.estimate.cameraFromTarget,
                     .squaredErrorPx = isComparable ? each.squaredErrorPx : first.squaredErrorPx});
  }
  return twins;
}

}  // namespace

std::optional<WorldPose> solveWorldPose(const CameraModel& camera, std::span<const WorldTag> tags,
                                        const std::optional<PosePrior>& prior) {
  std::vector<TagPoints> points;
  for (const WorldTag& tag : tags) points.push_back(worldPoints(tag));
  std::vector<Solution> solutions = solve(camera, tags, points);
  if (solutions.empty()) return std::nullopt;

  const auto used = static_cast<double>(solutions.front().agreeing());
  const TwinDecision decision = chooseTwin(asTwins(solutions), 8.0 * used - 6.0, prior);
  Solution& chosen = solutions[decision.index];
  return WorldPose{.estimate = chosen.estimate,
                   .choice = decision.choice,
                   .twinEvidence = decision.evidence,
                   .agrees = std::move(chosen.agrees)};
}

}  // namespace pleinair::tracking
