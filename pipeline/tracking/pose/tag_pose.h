#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <optional>
#include <span>

#include "pipeline/tracking/camera/camera_model.h"
#include "pipeline/tracking/pose/pose_ambiguity.h"
#include "pipeline/tracking/pose/pose_refinement.h"
#include "pipeline/tracking/pose/tag.h"

namespace pleinair::tracking {

/// Up to N values in place, for per-frame work without allocation.
template <class T, std::size_t N>
class FixedVector {
 public:
  /// Precondition: size() < N.
  void add(const T& value) {
    assert(size_ < N);
    values_[size_++] = value;
  }

  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* begin() { return values_.data(); }
  T* end() { return values_.data() + size_; }
  const T* begin() const { return values_.data(); }
  const T* end() const { return values_.data() + size_; }
  const T& operator[](std::size_t index) const {
    assert(index < size_);
    return values_[index];
  }

 private:
  std::array<T, N> values_{};
  std::size_t size_ = 0;
};

/// The pose of one tag; cameraFromTarget is cameraFromTag, in the frame of tagCorners().
struct TagPose {
  PoseEstimate estimate;
  std::optional<PoseEstimate> alternative;  ///< the rejected one
  AmbiguityResolution choice = AmbiguityResolution::kOnly;
  double ambiguityEvidence = kLoneEvidence;  ///< for this pose against its alternative
};

/// A tag's corners in its own frame and in the image.
std::array<Correspondence, 4> tagCorrespondences(const TagCornersPx& corners, double edgeMetres);

/// The pose of a square and its alternative.
using PoseCandidates = FixedVector<PoseEstimate, 2>;

/// Returns the one or two poses that explain a tag's corners, the better fit first; none where the
/// corners are degenerate. IPPE (Collins and Bartoli, "Infinitesimal Plane-Based Pose Estimation",
/// IJCV 2014; OpenCV's SOLVEPNP_IPPE_SQUARE) on undistorted corners; both are then refined in
/// pixels.
PoseCandidates tagPoseCandidates(const CameraModel& camera, const TagCornersPx& corners,
                                 double edgeMetres);

/// Chooses one of tagPoseCandidates() and rejects its alternative; nothing if there is none.
/// `prior`: the cameraFromTag suggested by the world's other tags or by the previous frame.
std::optional<TagPose> chooseTagPose(const PoseCandidates& candidates,
                                     const std::optional<PosePrior>& prior);

}  // namespace pleinair::tracking
