#pragma once

#include <array>
#include <optional>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <opencv2/core.hpp>
#include <opencv2/video/tracking.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {

class StaticRegionDetector;

/// Dense optical flow between two frames in both directions, by dense inverse search at half the
/// pyramid's size (Kroeger et al., "Fast optical flow using dense inverse search", 2016), or by the
/// image's homography where that fits as well; then refined per patch at the pyramid's size. The
/// error is predicted from noise, texture and the disagreement of the two directions. One thread at
/// a time; uses OpenCV's threads.
class DenseFlowEstimator {
 public:
  DenseFlowEstimator();

  /// Computes the flow from one frame to the next, both of one size. It is exactly zero in static
  /// cells.
  void update(const LumaPyramid& previous, const LumaPyramid& current,
              const std::optional<ImageHomography>& picture,
              const StaticRegionDetector* staticRegions, double noise);
  /// Valid until the next update().
  DenseFlow flow() const;
  /// Forgets the last flow, from which the search starts. OpenCV's search keeps a copy of it, so a
  /// new one is made.
  void reset();

  static constexpr int kStepPx = 8;  ///< approximate node spacing, px of the pyramid's image

 private:
  /// One of the two directions.
  struct Direction {
    cv::Ptr<cv::DISOpticalFlow> search;
    cv::Mat coarse;
    std::vector<glm::vec4> nodes;
  };
  void place(const LumaPyramid& current);
  /// Motion of the homography at a node.
  struct HomographyGuess {
    glm::dmat3 toFromFrom{1.0};
    double guessPx = 0.0;  // error of that guess
    bool isKnown = false;
    bool isHeld = false;  // exactly at rest
  };
  void estimateDirection(Direction& direction, const LumaPyramid& from, const LumaPyramid& to,
                         const cv::Mat& fromSmall, const cv::Mat& toSmall,
                         const HomographyGuess& homography, double noise) const;
  double edge(const std::vector<glm::vec4>& nodes, std::size_t index) const;
  void addDisagreement(const std::vector<glm::vec4>& back, std::vector<glm::vec4>& nodes) const;
  bool writeStaticNodes(const StaticRegionDetector* staticRegions);
  glm::dvec2 nodePx(std::size_t index) const;

  hal::FrameSize frameSize_;
  hal::FrameSize grid_;
  glm::dvec2 stepPx_{1.0};
  glm::dvec2 reduction_{1.0};
  std::array<cv::Mat, 2> small_;  // of the two frames
  std::array<Direction, 2> directions_;
  std::vector<float> staticErrors_;  // per node; kNotStatic where flow is estimated
};

}  // namespace pleinair::tracking
