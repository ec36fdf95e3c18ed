#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "pipeline/tracking/motion/image_motion.h"
#include "pipeline/tracking/motion/static_block.h"

namespace pleinair::tracking {

class LumaPyramid;

/// Finds the cells of an image that are static, in spite of noise. Each cell is compared with its
/// appearance when it came to rest and not with the previous frame, so that slow motion adds up and
/// is noticed. One thread at a time.
class StaticRegionDetector {
 public:
  /// Takes the next frame and its dominant motion.
  void update(const LumaPyramid& current, const std::optional<ImageHomography>& picture);
  /// Valid until the next update().
  StaticRegions fields() const { return {.fields = grid_, .errorPx = errors_}; }
  /// Standard deviation of a pixel of the followed image in levels; averaged over about a second.
  double noise() const { return noise_; }
  /// Returns the error of the cell at a position of the frame, or kNotStatic.
  float errorAt(const glm::dvec2& px, hal::FrameSize size) const;
  /// Treats the next frame as the first one.
  void reset();

 private:
  struct Cell {
    StaticBlock field;
    glm::dvec2 movedPx{0.0};        // smoothed
    int frames = 0;                 // since it came to rest
    double variance = 0.0;          // variance of its pixels beyond motion
    glm::dvec2 imageMotionPx{0.0};  // accumulated motion of the image since it came to rest
    bool hasBegun = false;
    bool isStatic = false;
    bool hasChanged = false;  // in this frame
    int waitFrames = 0;       // before it is compared again
    // Noise variance estimated from this frame's pixels, levels²; negative: none.
    double temporal = -1.0;
    double spatial = -1.0;
  };

  static bool isDoubtful(const Cell& cell, double noticedPx);
  void resize(const LumaPyramid& current);
  cv::Point corner(std::size_t index, const cv::Size& size) const;
  float assess(Cell& cell, const cv::Mat& picture, const cv::Point& corner, double scale);
  void restart(Cell& cell, const cv::Mat& picture, const cv::Point& corner);
  void measureNoise();
  /// A percentile of the cells' estimates, over those that have one; nothing for too few.
  std::optional<double> percentile(double Cell::*of, double part);

  hal::FrameSize grid_;
  cv::Size size_;
  std::vector<Cell> cells_;
  std::vector<float> errors_;
  std::vector<double> variances_;
  double noise_ = kUsualNoiseLevels;
  bool knowsNoise_ = false;
};

}  // namespace pleinair::tracking
