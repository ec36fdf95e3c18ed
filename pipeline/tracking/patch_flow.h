#pragma once

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// What is known of where a patch of a picture has gone, in px and grey levels of the picture.
struct PatchMatch {
  glm::dvec2 moved{0.0};
  double variance = 0.0;  ///< of the patch's differences there, apart from brightness; levels²
  double placing = 0.0;   ///< px of error by a level of difference; large where there is no texture
  bool isInside = false;  ///< else it has left the picture, and nothing more is known
};

/// A patch whose motion is asked about: by the inverse search of Baker and Matthews ("Lucas-Kanade
/// 20 years on", 2004), from guesses that are good to a pixel or two.
class FlowPatch {
 public:
  static constexpr int kSide = 8;

  /// Takes the patch with its middle at `middle`. Precondition: it and a pixel around it lie
  /// within the picture.
  FlowPatch(const cv::Mat& picture, const cv::Point& middle);

  /// How well the other picture fits at a guess.
  PatchMatch at(const cv::Mat& other, const glm::dvec2& moved) const;
  /// Improves a match. `noise` (levels) says how far the guess is held to where there is little
  /// texture.
  PatchMatch refined(const cv::Mat& other, const PatchMatch& guess, double noise) const;

 private:
  struct Sums {
    double x = 0.0;
    double y = 0.0;
    double variance = 0.0;
    bool isInside = false;
  };
  Sums compare(const cv::Mat& other, const glm::dvec2& moved) const;

  cv::Point corner_;
  alignas(16) short levels_[kSide][kSide];     // times kScale
  alignas(16) short gradientX_[kSide][kSide];  // times 2
  alignas(16) short gradientY_[kSide][kSide];
  double sumX_ = 0.0;
  double sumY_ = 0.0;
  // The gradients' products, apart from their means'.
  double xx_ = 0.0;
  double xy_ = 0.0;
  double yy_ = 0.0;
};

}  // namespace pleinair::tracking
