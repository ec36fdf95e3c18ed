#pragma once

#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>

#include "hal/pixel_format.h"
#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/image_motion.h"
#include "pipeline/tracking/motion/sway_detector.h"

namespace pleinair::tracking {

/// Suppresses jitter: of each feature, and of the image as a whole. A held feature has a fixed
/// position from which its motion is measured, so that slow motion accumulates until the feature is
/// released and the whole motion is reported at once. It also tells a camera that stands from one
/// whose fitted motion is that of a mover, by what is at rest. One thread at a time.
class JitterSuppressor {
 public:
  /// `isMounted`: ImageMotionOptions::isMounted.
  explicit JitterSuppressor(bool isMounted = false) : isMounted_(isMounted) {}

  /// Takes the features seen in the next frame, px of the frame. `scale`: size of a px of the
  /// measured image, in frame px.
  void update(std::span<const SeenFeature> seen, hal::FrameSize size, double scale);

  /// Features that the previous frame had too; valid until the next update().
  std::span<const FeatureMotion> features() const { return motions_; }
  const std::optional<ImageHomography>& picture() const { return picture_; }

  /// Treats the next frame as the first one.
  void reset();

 private:
  /// Reported state of a feature.
  struct ReportedFeature {
    std::uint32_t id = 0;
    glm::dvec2 px{0.0};         // reported position
    glm::dvec2 quietFrom{0.0};  // centre of the band in which it has stayed …
    int quietFrames = 0;        // … for this many frames
    int beyondFrames = 0;  // consecutive frames in which it was seen away from its held position
    bool isHeld = true;
    bool agrees = false;  // with the image's motion, in this frame
    bool isNew = true;
    double errorPx = 0.0;
    glm::dvec2 seenPx{0.0};
  };

  /// In how many places of the image features …
  struct PlaceCounts {
    std::size_t seen = 0;
    std::size_t atRest = 0;
    std::size_t contradicted = 0;  ///< are at rest, although the fit moves them
    std::size_t hit = 0;           ///< move as the fit moves them
  };

  void match(std::span<const SeenFeature> seen);
  PlaceCounts countPlaces(const HomographyFit& fit, hal::FrameSize size, double scale) const;
  bool contradictsRest(const PlaceCounts& places) const;
  static bool isShifted(const PlaceCounts& places);
  bool restSpeaksAgainst(const std::optional<HomographyFit>& fit, hal::FrameSize size,
                         double scale);
  void calibrate(const HomographyFit& fit);
  void movePicture(hal::FrameSize size, double scale, bool standsBeforeSway);
  void suppressJitter(const HomographyFit& fit, hal::FrameSize size, double scale);
  void releasePicture(const HomographyFit& fit, hal::FrameSize size, double scale);
  void moveFeature(ReportedFeature& reported, double scale);

  bool isMounted_;
  HomographyFitter fitter_;
  SwayDetector sway_;
  std::vector<ReportedFeature> reported_;  // by rising id
  std::vector<ReportedFeature> next_;
  std::vector<PointPair> pairs_;
  std::vector<double> apart_;        // of features at rest, in their errors: from the fit …
  std::vector<double> moved_;        // … and from where they were
  std::vector<std::size_t> pairOf_;  // index in reported_, per pair
  std::vector<FeatureMotion> motions_;
  std::optional<ImageHomography> picture_;
  bool isHeld_ = true;
  bool isSettling_ = false;      // the image has just become held
  glm::dmat3 quietMotion_{1.0};  // motion of the image since it only jitters
  int quietFrames_ = 0;
  double calibration_ = 1.0;  // factor on the features' predicted errors
  std::vector<double> ratios_;
};

}  // namespace pleinair::tracking
