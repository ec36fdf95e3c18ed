#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// One field of a picture that may stand still: how it looked when it came to rest, averaged over
/// the first frames so that it has little noise of its own, and how far what is seen now is from
/// that. Motion is the shift that explains the difference best (one step of Lucas and Kanade,
/// 1981), beside a change of brightness and contrast, which is none. In px and grey levels of the
/// picture.
class StaticBlock {
 public:
  static constexpr int kSide = 16;
  static constexpr int kReferenceFrames = 16;  ///< most that are averaged

  /// What is found in a frame.
  struct Change {
    glm::dvec2 movedPx{0.0};
    double placing = 0.0;   ///< px of error of it by a level of the frame's noise
    double variance = 0.0;  ///< of a pixel, of what motion and light do not explain; levels²
  };

  /// Begins anew with what a picture shows at `corner` now.
  void restart(const cv::Mat& picture, const cv::Point& corner);
  /// Precondition: restart() was called.
  Change compare(const cv::Mat& picture, const cv::Point& corner) const;
  /// Adds a frame to the average. Precondition: frames() < kReferenceFrames.
  void add(const cv::Mat& picture, const cv::Point& corner);
  int frames() const { return frames_; }

 private:
  // With a frame of one pixel around it, for gradients.
  static constexpr int kTile = kSide + 2;
  using Tile = std::array<std::int16_t, static_cast<std::size_t>(kTile) * kTile>;
  using Gradient = std::array<std::int16_t, static_cast<std::size_t>(kSide) * kSide>;
  static constexpr int kScale = 4;  // of the average's levels
  static constexpr int kPixels = kSide * kSide;

  void finish();

  Tile sum_{};
  Tile mean_{};   // times kScale
  Gradient x_{};  // times 2 kScale
  Gradient y_{};
  cv::Matx44d inverse_;  // of the normal equations of shift, brightness and contrast
  int frames_ = 0;
};

/// A pixel's noise as the picture itself shows it: of each field as if it were flat, so too large
/// where there is texture (Immerkær, "Fast noise variance estimation", 1996). Levels. Precondition:
/// the field and a pixel around it lie in the picture.
double spatialNoise(const cv::Mat& picture, const cv::Point& corner, int side);

}  // namespace pleinair::tracking
