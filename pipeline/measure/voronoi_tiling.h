#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::measure {

/// The simplest painting: a Voronoi tiling of the screen with one random seed in each square of 8×8
/// px, each tile in the mean colour of its area. It ignores motion, so a measure of coherence must
/// detect it.
class VoronoiTiling {
 public:
  VoronoiTiling(cv::Size size, std::uint64_t seed);

  /// Precondition: the image has the constructor's size.
  cv::Mat3f paint(const cv::Mat3f& picture) const;

 private:
  cv::Mat1i tiles_;  ///< index of the tile of each pixel
  int count_ = 0;
};

}  // namespace pleinair::measure
