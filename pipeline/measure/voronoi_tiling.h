#pragma once

#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::measure {

/// The plainest painting there is: a Voronoi tiling of the screen with one seed at random in each
/// square of 8×8 px, each tile in the mean colour of what it covers. It knows of no motion, so that
/// it is what a measure of coherence has to see through.
class VoronoiTiling {
 public:
  VoronoiTiling(cv::Size size, std::uint64_t seed);

  /// Precondition: a picture of the constructor's size.
  cv::Mat3f paint(const cv::Mat3f& picture) const;

 private:
  cv::Mat1i tiles_;  ///< which tile each pixel is in
  int count_ = 0;
};

}  // namespace pleinair::measure
