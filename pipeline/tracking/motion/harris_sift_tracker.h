#pragma once

#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>

#include "hal/pixel_format.h"
#include "pipeline/tracking/motion/feature_tracker.h"
#include "pipeline/tracking/motion/motion_outliers.h"

namespace pleinair::tracking {

/// The thesis's tracker (§4.3.2): Harris corners at least a fifth as strong as the strongest, with
/// SIFT descriptors, matched with the previous frame by the ratio test; FLANN's k-d trees search,
/// as the thesis suggests. Beyond the thesis, corners are located to sub-pixels, and a match is
/// dropped when all its neighbours move differently, since the thesis rejects wrong matches by the
/// ratio only.
class HarrisSiftTracker : public FeatureTracker {
 public:
  HarrisSiftTracker();

  std::span<const SeenFeature> follow(std::shared_ptr<const LumaPyramid> current,
                                      double noise) override;
  double foundShare() const override { return foundShare_; }
  void reset() override;

 private:
  /// The features of one frame.
  struct Features {
    std::vector<cv::Point2f> places;  // pyramid px
    std::vector<std::uint32_t> ids;
    cv::Mat descriptors;
  };
  struct Match {
    int current = 0;
    int previous = 0;
  };

  void findCorners(const LumaPyramid& current);
  void describe(const LumaPyramid& current);
  void match();
  void publish(const LumaPyramid& current);

  cv::Ptr<cv::SIFT> sift_;
  cv::FlannBasedMatcher matcher_;
  MotionOutliers outliers_;
  Features previous_;
  Features current_;
  std::vector<cv::KeyPoint> keypoints_;
  cv::Mat strength_;
  cv::Mat strongestNear_;
  std::vector<std::vector<cv::DMatch>> nearest_;
  std::vector<Match> matches_;
  std::vector<float> previousBest_;
  std::vector<cv::Point2f> places_;  // of the matches
  std::vector<cv::Point2f> steps_;
  std::vector<SeenFeature> seen_;
  hal::FrameSize frameSize_;
  std::uint32_t nextId_ = 0;
  double foundShare_ = 0.0;
};

}  // namespace pleinair::tracking
