#include "pipeline/tracking/pose/world_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include <glm/matrix.hpp>

namespace pleinair::tracking {
namespace {

/// A tag whose corners are further than this (RMS) from the position that the others give it
/// contradicts them and is left out of the solution.
constexpr double kContradictionPx = 4.0;
/// Error of one small tag's own pose at the other end of the image, at most. A tag further away
/// counts only this much in a hypothesis' score.
constexpr double kHypothesisPx = 12.0;
constexpr double kHuberPx = 1.5;
/// Hypotheses nearer to each other than this are the same solution.
constexpr double kSamePoseRad = 0.03;
constexpr int kMaxRounds = 8;
/// Hypotheses that are refined, best first: two are wanted, and those of a contradicting tag come
/// in between.
constexpr int kMaxRefined = 8;

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

}  // namespace

std::ptrdiff_t WorldPoseSolver::Solution::agreeing() const {
  return std::ranges::count(agrees, 1);
}

bool WorldPoseSolver::Solution::isNear(const glm::dmat4& cameraFromWorld) const {
  return rotationBetweenRad(estimate.cameraFromTarget, cameraFromWorld) < kSamePoseRad;
}

/// Collects all tags' poses as poses of the camera, best first.
void WorldPoseSolver::collectHypotheses(const CameraModel& camera, std::span<const WorldTag> tags) {
  hypotheses_.clear();
  for (const WorldTag& tag : tags) {
    for (const PoseEstimate& candidate : tag.candidates) {
      Hypothesis hypothesis{.cameraFromWorld =
                                candidate.cameraFromTarget * glm::inverse(tag.worldFromTag)};
      for (const TagPoints& each : points_) {
        const double rms = rmsPx(camera, each, hypothesis.cameraFromWorld);
        hypothesis.score += std::min(rms * rms, kHypothesisPx * kHypothesisPx);
      }
      hypotheses_.push_back(hypothesis);
    }
  }
  std::ranges::sort(hypotheses_, {}, &Hypothesis::score);
}

/// Marks the tags that a pose projects to within `tolerancePx` of their corners.
void WorldPoseSolver::judge(const CameraModel& camera, const glm::dmat4& pose, double tolerancePx,
                            Agreement& agrees) const {
  agrees.clear();
  for (const TagPoints& each : points_) {
    agrees.push_back(rmsPx(camera, each, pose) <= tolerancePx ? 1 : 0);
  }
}

/// Refines over the tags that agree with the start, then over those that agree with the result,
/// until the set does not change. Returns false if all are lost on the way.
bool WorldPoseSolver::refineFrom(const CameraModel& camera, const glm::dmat4& start,
                                 double tolerancePx, Solution& solution) {
  judge(camera, start, tolerancePx, solution.agrees);
  glm::dmat4 pose = start;
  for (int round = 0; round < kMaxRounds; ++round) {
    used_.clear();
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (solution.agrees[i] != 0) used_.insert(used_.end(), points_[i].begin(), points_[i].end());
    }
    const std::optional<PoseEstimate> refined = refinePose(camera, used_, pose, kHuberPx);
    if (!refined) return false;
    solution.estimate = *refined;
    pose = refined->cameraFromTarget;
    solution.squaredErrorPx = squaredErrorPx(camera, used_, pose);
    judge(camera, pose, kContradictionPx, nextAgrees_);
    if (nextAgrees_ == solution.agrees) return true;
    if (round + 1 < kMaxRounds) solution.agrees.swap(nextAgrees_);
  }
  return true;
}

/// A wide tolerance admits all valid tags although the hypothesis is crude, but a moved tag may
/// bend the pose until none agrees; the narrow one admits tags one after another. Returns null
/// where neither converges.
WorldPoseSolver::Solution* WorldPoseSolver::refine(const CameraModel& camera,
                                                   const glm::dmat4& start) {
  const bool hasWide = refineFrom(camera, start, kHypothesisPx, wide_);
  if (hasWide && wide_.agreeing() == std::ssize(points_)) return &wide_;
  const bool hasNarrow = refineFrom(camera, start, kContradictionPx, narrow_);
  if (hasWide && hasNarrow) return wide_.agreeing() > narrow_.agreeing() ? &wide_ : &narrow_;
  if (hasWide) return &wide_;
  return hasNarrow ? &narrow_ : nullptr;
}

/// Accepts a solution that explains more tags than the current one, or that is its alternative: it
/// explains as many with another rotation.
void WorldPoseSolver::accept(Solution& solution) {
  if (solutionCount_ == 0 || solution.agreeing() > solutions_[0].agreeing()) {
    std::swap(solutions_[0], solution);
    solutionCount_ = 1;
  } else if (solution.agreeing() == solutions_[0].agreeing() &&
             !solutions_[0].isNear(solution.estimate.cameraFromTarget)) {
    std::swap(solutions_[solutionCount_++], solution);
  }
}

/// Orders the solutions by fit, the better one first.
void WorldPoseSolver::findSolutions(const CameraModel& camera) {
  solutionCount_ = 0;
  int refinedCount = 0;
  for (const Hypothesis& hypothesis : hypotheses_) {
    if (solutionCount_ == solutions_.size() || refinedCount == kMaxRefined) break;
    const bool isKnown = std::ranges::any_of(solutions(), [&](const Solution& other) {
      return other.isNear(hypothesis.cameraFromWorld);
    });
    if (isKnown) continue;
    ++refinedCount;
    if (Solution* const solution = refine(camera, hypothesis.cameraFromWorld)) accept(*solution);
  }
  if (!std::ranges::is_sorted(solutions(), {}, &Solution::squaredErrorPx)) {
    std::ranges::reverse(solutions());  // two at most
  }
}

std::optional<WorldPose> WorldPoseSolver::solve(const CameraModel& camera,
                                                std::span<const WorldTag> tags,
                                                const std::optional<PosePrior>& prior) {
  points_.clear();
  for (const WorldTag& tag : tags) points_.push_back(worldPoints(tag));
  collectHypotheses(camera, tags);
  findSolutions(camera);
  if (solutionCount_ == 0) return std::nullopt;

  // Errors over different sets of tags do not tell which solution is right: the choice stays
  // ambiguous.
  const Solution& first = solutions_.front();
  FixedVector<PoseCandidate, 2> alternatives;
  for (const Solution& each : solutions()) {
    const bool isComparable = each.agrees == first.agrees;
    alternatives.add({.cameraFromTarget = each.estimate.cameraFromTarget,
                      .squaredErrorPx = isComparable ? each.squaredErrorPx : first.squaredErrorPx});
  }
  const AmbiguityDecision decision =
      resolveAmbiguity(alternatives, 8.0 * static_cast<double>(first.agreeing()) - 6.0, prior);
  const Solution& chosen = solutions_[decision.index];
  return WorldPose{.estimate = chosen.estimate,
                   .choice = decision.choice,
                   .ambiguityEvidence = decision.evidence,
                   .agrees = chosen.agrees};
}

}  // namespace pleinair::tracking
