#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat4x4.hpp>

#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/pose_ambiguity.h"
#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/tag.h"
#include "pipeline/tracking/pose/tag_pose.h"

namespace pleinair::tracking {

/// A tag whose place in the world is known, and its appearance in the image.
struct WorldTag {
  glm::dmat4 worldFromTag{1.0};
  double edgeMetres = 0.0;
  TagCornersPx corners{};
  PoseCandidates candidates;  ///< from tagPoseCandidates()
};

struct WorldPose {
  PoseEstimate estimate;  ///< cameraFromTarget is cameraFromWorld
  AmbiguityResolution choice = AmbiguityResolution::kOnly;
  double ambiguityEvidence = kLoneEvidence;  ///< for this solution against its alternative
  /// Per tag: 1 where it was used, 0 where it contradicts the used ones; valid until the next
  /// solve().
  std::span<const std::uint8_t> agrees;
};

/// Solves the camera's pose from all tags together. Each tag's poses, alternatives included, are
/// hypotheses; the two that explain all tags best are refined over all their corners. Tags that
/// contradict them are left out, and the wrong one of the two is rejected as for a single tag.
/// Keeps its buffers from frame to frame, and no other state; one thread at a time.
class WorldPoseSolver {
 public:
  /// Returns nothing where no tag has a pose.
  std::optional<WorldPose> solve(const CameraModel& camera, std::span<const WorldTag> tags,
                                 const std::optional<PosePrior>& prior);

 private:
  using TagPoints = std::array<Correspondence, 4>;
  using Agreement = std::vector<std::uint8_t>;
  struct Hypothesis {
    glm::dmat4 cameraFromWorld{1.0};
    double score = 0.0;  // px²
  };
  struct Solution {
    PoseEstimate estimate;
    Agreement agrees;
    double squaredErrorPx = 0.0;

    std::ptrdiff_t agreeing() const;
    bool isNear(const glm::dmat4& cameraFromWorld) const;
  };

  void collectHypotheses(const CameraModel& camera, std::span<const WorldTag> tags);
  void findSolutions(const CameraModel& camera);
  bool refineFrom(const CameraModel& camera, const glm::dmat4& start, double tolerancePx,
                  Solution& solution);
  Solution* refine(const CameraModel& camera, const glm::dmat4& start);
  void accept(Solution& solution);
  void judge(const CameraModel& camera, const glm::dmat4& pose, double tolerancePx,
             Agreement& agrees) const;
  std::span<Solution> solutions() { return std::span(solutions_).first(solutionCount_); }

  std::vector<TagPoints> points_;  // per tag, in the world
  std::vector<Hypothesis> hypotheses_;
  std::vector<Correspondence> used_;
  Agreement nextAgrees_;
  Solution wide_;
  Solution narrow_;
  std::array<Solution, 2> solutions_;  // the solution that explains most tags, and its alternative
  std::size_t solutionCount_ = 0;
};

}  // namespace pleinair::tracking
