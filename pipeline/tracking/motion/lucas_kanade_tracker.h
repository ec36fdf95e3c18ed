#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/tracking/image/corners.h"
#include "pipeline/tracking/image/homography.h"
#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/image/search_patch.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/motion_outliers.h"

namespace pleinair::tracking {

/// Corners spread over the image. Lucas-Kanade follows each from the key frame in which its
/// appearance was taken, so that nothing drifts from frame to frame. Several key frames are kept: a
/// new one is made where features have become few or stale, and takes over only those features.
class LucasKanadeTracker : public FeatureTracker {
 public:
  LucasKanadeTracker();

  std::span<const SeenFeature> follow(std::shared_ptr<const LumaPyramid> current,
                                      double noise) override;
  double foundShare() const override { return foundShare_; }
  void reset() override;

 private:
  struct Feature {
    std::uint32_t id = 0;
    std::size_t key = 0;   // index in keys_
    cv::Point2f origin;    // position in the key frame; pyramid px, as `at`
    cv::Point2f at;        // position in this frame, predicted if it was not found
    cv::Point2f previous;  // position in the previous frame
    cv::Point2f step;      // motion since the previous frame
    FeaturePatch patch;    // patch of the key frame
    double errorPx = 0.0;
    double difference = 0.0;  // difference of appearance, RMS levels
    bool isFound = false;
    bool wasFound = false;
    bool isStale = false;  // its appearance differs from the key frame
    int missingFrames = 0;
  };
  /// Number of features found, and number of grid cells that have one.
  struct Spread {
    std::size_t features = 0;
    std::size_t fields = 0;
  };

  static FeaturePatch patchAt(const LumaPyramid& pyramid, const cv::Point2f& at);
  void find(const LumaPyramid& current, bool all, int levels);
  void judge(Feature& feature, const LumaPyramid& current, std::size_t of,
             const cv::Point2f& found);
  bool searchWidely(const LumaPyramid& current);
  void reconsider(const LumaPyramid& current);
  void rejectOutliers();
  double shareFound() const;
  void guessMissing(const LumaPyramid& current);
  Spread spread(const LumaPyramid& current);
  bool needsKey(const Spread& have) const;
  void findCorners(const LumaPyramid& current);
  void centre(const LumaPyramid& current);
  void makeKey(const std::shared_ptr<const LumaPyramid>& current, bool isNeeded);
  std::size_t freeKey(const LumaPyramid& current);
  void takeOver(Feature& feature, std::size_t key, const LumaPyramid& current);
  void publish(const LumaPyramid& current);

  static constexpr std::size_t kKeys = 4;
  std::array<std::shared_ptr<const LumaPyramid>, kKeys> keys_;
  std::shared_ptr<const LumaPyramid> previous_;
  PointFollower follower_;
  CornerSearch corners_;
  HomographyFitter fitter_;
  MotionOutliers outliers_;
  std::vector<Feature> features_;
  std::vector<Feature> before_;  // copy from before reconsider()
  std::vector<PointPair> pairs_;
  std::vector<SeenFeature> seen_;
  std::uint32_t nextId_ = 0;
  double foundShare_ = 0.0;
  double noise_ = 2.0;  // levels
  int framesSinceKey_ = 0;
  Spread keySpread_;  // after the last key frame was made
  // Features of one key frame.
  std::vector<std::size_t> members_;
  std::vector<cv::Point2f> origins_;
  std::vector<cv::Point2f> points_;
  std::vector<cv::Point2f> newCorners_;
  std::vector<unsigned char> cells_;  // whether each cell has a feature
  std::vector<cv::Point2f> steps_;
};

}  // namespace pleinair::tracking
