#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>

#include "hal/pixel_format.h"
#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

/// Keeps still what only trembles: each feature, and the picture as a whole. What is held has a
/// place from which motion is measured, not a frame before, so that slow motion adds up until it
/// is let go and reported at once: nothing of it is lost. One thread at a time.
class JitterSuppressor {
 public:
  /// Takes what was seen in the next frame, px of the frame. `scale`: frame px in a px of the
  /// picture in which it was measured.
  void update(std::span<const SeenFeature> seen, hal::FrameSize size, double scale);

  /// Features that were there in the frame before, too; kept until the next update().
  std::span<const FeatureMotion> features() const { return motions_; }
  const std::optional<PictureHomography>& picture() const { return picture_; }

  /// The next frame is a first one.
  void reset();

 private:
  /// What has been reported of a feature.
  struct ReportedFeature {
    std::uint32_t id = 0;
    glm::dvec2 px{0.0};         // where it was said to be
    glm::dvec2 quietFrom{0.0};  // from where it has trembled only …
    int quietFrames = 0;        // … for so long
    int beyondFrames = 0;       // in a row that it was seen away from where it is held
    bool isHeld = true;
    bool agrees = false;  // with the picture, now
    bool isNew = true;
    double errorPx = 0.0;
    glm::dvec2 seenPx{0.0};
  };

  void match(std::span<const SeenFeature> seen);
  void calibrate(const HomographyFit& fit);
  void movePicture(hal::FrameSize size, double scale);
  void suppressJitter(const HomographyFit& fit, hal::FrameSize size, double scale);
  void releasePicture(const HomographyFit& fit, hal::FrameSize size, double scale);
  void moveFeature(ReportedFeature& reported, double scale);

  HomographyFitter fitter_;
  std::vector<ReportedFeature> reported_;  // by rising id
  std::vector<ReportedFeature> next_;
  std::vector<PointPair> pairs_;
  std::vector<std::size_t> pairOf_;  // of each pair, in reported_
  std::vector<FeatureMotion> motions_;
  std::optional<PictureHomography> picture_;
  bool isHeld_ = true;
  bool isSettling_ = false;      // the picture has just become held
  glm::dmat3 quietMotion_{1.0};  // of the picture, since it has trembled only
  int quietFrames_ = 0;
  double calibration_ = 1.0;  // of the features' predicted errors
  std::vector<double> ratios_;
};

}  // namespace pleinair::tracking
