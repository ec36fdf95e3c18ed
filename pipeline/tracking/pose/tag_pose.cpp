#include "pipeline/tracking/pose/tag_pose.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <opencv2/calib3d.hpp>

namespace pleinair::tracking {
namespace {

/// Alternatives nearer than this are one pose that was refined from two starts.
constexpr double kSamePoseRad = 1e-4;

glm::dmat4 toPose(const cv::Mat& rotationVector, const cv::Mat& translation) {
  cv::Matx33d rotation;
  cv::Rodrigues(rotationVector, rotation);
  glm::dmat4 pose(1.0);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) pose[column][row] = rotation(row, column);
    pose[3][row] = translation.at<double>(row);
  }
  return pose;
}

/// Whether corners in tagCorners()' order show the front of a square: counter-clockwise (the area
/// that any three enclose is negative, y down), and none collinear with its neighbours.
bool showFront(const TagCornersPx& corners) {
  constexpr double kMinAreaPx = 0.5;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const glm::dvec2 in = corners[(i + 1) % 4] - corners[i];
    const glm::dvec2 out = corners[(i + 2) % 4] - corners[(i + 1) % 4];
    if (!(in.x * out.y - in.y * out.x < -kMinAreaPx)) return false;
  }
  return true;
}

/// Up to two poses by IPPE from rays (x, y, 1). OpenCV asks for a square's corners as (−, +), (+,
/// +), (+, −), (−, −) and takes their axes as given, so tagCorners() fits as it is.
FixedVector<glm::dmat4, 2> ippePoses(const std::array<cv::Point2d, 4>& rays, double edgeMetres) {
  std::array<cv::Point3d, 4> object;
  std::ranges::transform(tagCorners(edgeMetres), object.begin(),
                         [](const glm::dvec3& p) { return cv::Point3d(p.x, p.y, p.z); });
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  try {
    cv::solvePnPGeneric(object, rays, cv::Matx33d::eye(), cv::noArray(), rotations, translations,
                        false, cv::SOLVEPNP_IPPE_SQUARE);
  } catch (const cv::Exception&) {  // corners on a line or in a point
    return {};
  }
  FixedVector<glm::dmat4, 2> poses;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    poses.add(toPose(rotations[i], translations[i]));
  }
  return poses;
}

}  // namespace

std::array<Correspondence, 4> tagCorrespondences(const TagCornersPx& corners, double edgeMetres) {
  const std::array<glm::dvec3, 4> object = tagCorners(edgeMetres);
  std::array<Correspondence, 4> points{};
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {object[i], corners[i]};
  return points;
}

PoseCandidates tagPoseCandidates(const CameraModel& camera, const TagCornersPx& corners,
                                 double edgeMetres) {
  if (!showFront(corners)) return {};
  std::array<cv::Point2d, 4> rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const std::optional<glm::dvec3> ray = camera.unproject(corners[i]);
    if (!ray) return {};
    rays[i] = {ray->x, ray->y};
  }
  const std::array<Correspondence, 4> points = tagCorrespondences(corners, edgeMetres);
  PoseCandidates candidates;
  for (const glm::dmat4& start : ippePoses(rays, edgeMetres)) {
    const std::optional<PoseEstimate> refined = refinePose(camera, points, start);
    if (!refined) continue;
    const bool isKnown = std::ranges::any_of(candidates, [&](const PoseEstimate& other) {
      return rotationBetweenRad(other.cameraFromTarget, refined->cameraFromTarget) < kSamePoseRad;
    });
    if (!isKnown) candidates.add(*refined);
  }
  if (!std::ranges::is_sorted(candidates, {}, &PoseEstimate::rmsPx)) {
    std::ranges::reverse(candidates);  // two at most
  }
  return candidates;
}

std::optional<TagPose> chooseTagPose(const PoseCandidates& candidates,
                                     const std::optional<PosePrior>& prior) {
  if (candidates.empty()) return std::nullopt;
  FixedVector<PoseCandidate, 2> alternatives;
  for (const PoseEstimate& pose : candidates) {
    alternatives.add({.cameraFromTarget = pose.cameraFromTarget,
                      .squaredErrorPx = 4.0 * pose.rmsPx * pose.rmsPx});
  }
  const AmbiguityDecision decision = resolveAmbiguity(alternatives, 2.0, prior);
  TagPose pose{.estimate = candidates[decision.index],
               .choice = decision.choice,
               .ambiguityEvidence = decision.evidence};
  if (candidates.size() > 1) pose.alternative = candidates[1 - decision.index];
  return pose;
}

}  // namespace pleinair::tracking
