#pragma once

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// What is known of where a patch of a picture has gone, in px and grey levels of the picture.
struct PatchMatch {
  glm::dvec2 moved{0.0};
  double variance = 0.0;    ///< of the patch's differences there, apart from brightness; levels²
  double brightness = 0.0;  ///< their mean, levels
  bool isInside = false;    ///< else it has left the picture, and nothing is known
};

/// A patch whose motion is asked about: by the inverse search of Baker and Matthews ("Lucas-Kanade
/// 20 years on", 2004), from guesses that are good to a pixel or two. A change of brightness is
/// none of its motion.
template <int kSide>
class SearchPatch {
 public:
  static constexpr int kReach = kSide / 2 + 1;

  /// Takes the patch with its middle between the pixels before and at `middle`. Precondition: that
  /// is kReach from the picture's sides.
  SearchPatch(const cv::Mat& picture, const cv::Point& middle);
  /// The nearest middle to a point (own px, integer centres). Precondition: a picture of twice
  /// kReach.
  static cv::Point middleNear(const cv::Mat& picture, const cv::Point2f& point);

  /// px of error by a level of difference (Cramér and Rao's bound); large where there is no more
  /// texture than `noise` (levels) makes.
  /// Knowing that the brightness has not changed, one places it better.
  double placing(double noise, bool isBrightnessKnown = false) const;
  static constexpr double kMostPlacing = 100.0;
  /// Standard deviation of its levels.
  double contrast() const { return contrast_; }

  /// How well the other picture fits at a guess.
  PatchMatch at(const cv::Mat& other, const glm::dvec2& moved) const;
  /// Improves a match that is good to `guessPx`: held to it where noise (levels) would say more
  /// than texture.
  PatchMatch refined(const cv::Mat& other, const PatchMatch& guess, double noise,
                     double guessPx = 0.3) const;

 private:
  struct Sums {
    double x = 0.0;  // of differences by gradients, apart from light
    double y = 0.0;
    double variance = 0.0;
    double brightness = 0.0;
    bool isInside = false;
  };
  Sums compare(const cv::Mat& other, const glm::dvec2& moved) const;

  cv::Point corner_;
  alignas(16) short levels_[kSide][kSide];
  alignas(16) short gradientX_[kSide][kSide];  // times 2
  alignas(16) short gradientY_[kSide][kSide];
  double meanX_ = 0.0;
  double meanY_ = 0.0;
  double contrast_ = 0.0;
  // Sums of the gradients' products, apart from their means.
  double xx_ = 0.0;
  double xy_ = 0.0;
  double yy_ = 0.0;
};

using FlowPatch = SearchPatch<8>;
using FeaturePatch = SearchPatch<16>;

}  // namespace pleinair::tracking
