#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// One block of the image that may be static. Its reference is the average of its first frames at
/// rest, which has little noise; each frame is compared with it. Motion is the shift that explains
/// the difference best (one step of Lucas and Kanade, 1981), beside a change of brightness and
/// contrast, which does not count as motion. In px and grey levels of the image.
class StaticBlock {
 public:
  static constexpr int kSide = 16;
  static constexpr int kReferenceFrames = 16;  ///< most frames that are averaged

  /// Change found in a frame.
  struct Change {
    glm::dvec2 movedPx{0.0};
    double placing = 0.0;   ///< position error (px) per level of the frame's noise
    double variance = 0.0;  ///< variance of a pixel that motion and light do not explain; levels²
  };

  /// Restarts with the image's content at `corner` as the reference.
  void restart(const cv::Mat& picture, const cv::Point& corner);
  /// Precondition: restart() was called.
  Change compare(const cv::Mat& picture, const cv::Point& corner) const;
  /// Adds a frame to the average. Precondition: frames() < kReferenceFrames.
  void add(const cv::Mat& picture, const cv::Point& corner);
  int frames() const { return frames_; }

 private:
  // The block and a border of one pixel, for gradients.
  static constexpr int kTile = kSide + 2;
  using Tile = std::array<std::int16_t, static_cast<std::size_t>(kTile) * kTile>;
  using Gradient = std::array<std::int16_t, static_cast<std::size_t>(kSide) * kSide>;
  static constexpr int kScale = 4;  // fixed-point scale of the average
  static constexpr int kPixels = kSide * kSide;

  void finish();

  Tile sum_{};
  Tile mean_{};   // times kScale
  Gradient x_{};  // times 2 kScale
  Gradient y_{};
  cv::Matx44d inverse_;  // inverse of the normal equations of shift, brightness and contrast
  int frames_ = 0;
};

/// Estimates a pixel's noise (levels) from one image, as if each block were flat, so the estimate
/// is too large where there is texture (Immerkær, "Fast noise variance estimation", 1996).
/// Precondition: the block and a border of one pixel lie in the image.
double spatialNoise(const cv::Mat& picture, const cv::Point& corner, int side);

}  // namespace pleinair::tracking
