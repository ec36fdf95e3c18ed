#pragma once

#include <cstddef>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

namespace pleinair::tracking {

class LumaPyramid;

/// Finds how much of one frame is still seen in another: block matching of reduced frames by
/// normalised correlation, which ignores gain and offset, over all shifts by up to 0.3 of the
/// sides. Blocks that are seen again move together; blocks of another view match at random places.
/// One thread at a time; uses OpenCV's threads.
class ViewComparison {
 public:
  /// A frame reduced to about a hundred px along its longer side.
  class View {
   public:
    void load(const LumaPyramid& pyramid);
    const cv::Mat& picture() const { return picture_; }
    /// Px of the pyramid's first level for each px.
    double reduction() const { return reduction_; }

   private:
    cv::Mat picture_;
    double reduction_ = 1.0;
  };

  struct Result {
    std::size_t textured = 0;  ///< blocks of the earlier frame that have enough texture to be found
    /// Part of them that is seen again under one motion, beyond the two that determine it.
    double sharedPart = 0.0;
  };
  /// `noise` is that of a pixel of the pyramids, in levels.
  Result compare(const View& before, const View& after, double noise);

 private:
  struct Block {
    glm::dvec2 before{0.0};
    glm::dvec2 after{0.0};
    double correlation = 0.0;
    bool isTextured = false;
  };
  static void match(Block& block, const cv::Mat& before, const cv::Mat& after, double minTexture);
  std::size_t agreeing() const;

  std::vector<Block> blocks_;
};

}  // namespace pleinair::tracking
