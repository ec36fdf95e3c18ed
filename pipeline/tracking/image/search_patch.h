#pragma once

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// Measured motion of an image patch, in px and grey levels of the image.
struct PatchMatch {
  glm::dvec2 moved{0.0};
  /// Variance of the patch's differences there, without brightness; levels².
  double variance = 0.0;
  double brightness = 0.0;  ///< mean difference, levels
  bool isInside = false;    ///< false: the patch has left the image, and nothing is known
};

/// A patch whose motion is measured by the inverse search of Baker and Matthews ("Lucas-Kanade 20
/// years on", 2004). Guesses must be good to a pixel or two. A change of brightness does not count
/// as motion.
template <int kSide>
class SearchPatch {
 public:
  static constexpr int kReach = kSide / 2 + 1;

  /// Takes the patch whose centre lies between the pixels before and at `middle`. Precondition:
  /// `middle` is at least kReach from the image's sides.
  SearchPatch(const cv::Mat& picture, const cv::Point& middle);
  /// The allowed middle nearest to a point (pyramid px, integer centres). Precondition: the image
  /// is at least twice kReach wide and high.
  static cv::Point middleNear(const cv::Mat& picture, const cv::Point2f& point);

  /// Position error (px) per grey level of difference (Cramér-Rao bound). It is large where `noise`
  /// (levels) alone explains the texture. Position is known better when the brightness is known not
  /// to have changed.
  double placing(double noise, bool isBrightnessKnown = false) const;
  static constexpr double kMaxPlacing = 100.0;
  /// Standard deviation of the patch's grey levels.
  double contrast() const { return contrast_; }

  /// Compares the patch with the other image at a guessed motion.
  PatchMatch at(const cv::Mat& other, const glm::dvec2& moved) const;
  /// Improves a match whose motion is known to `guessPx`. The result stays near the guess where
  /// noise (levels) outweighs texture.
  PatchMatch refined(const cv::Mat& other, const PatchMatch& guess, double noise,
                     double guessPx = 0.3) const;

 private:
  struct Sums {
    double x = 0.0;  // sums of differences times gradients, without brightness
    double y = 0.0;
    double variance = 0.0;
    double brightness = 0.0;
    bool isInside = false;
  };
  Sums compare(const cv::Mat& other, const glm::dvec2& moved) const;

  cv::Point corner_;
  alignas(16) short levels_[kSide][kSide];
  alignas(16) short gradientX_[kSide][kSide];  // gradient times 2
  alignas(16) short gradientY_[kSide][kSide];
  double meanX_ = 0.0;
  double meanY_ = 0.0;
  double contrast_ = 0.0;
  // Sums of the gradients' products about their means.
  double xx_ = 0.0;
  double xy_ = 0.0;
  double yy_ = 0.0;
};

using FlowPatch = SearchPatch<8>;
using FeaturePatch = SearchPatch<16>;

}  // namespace pleinair::tracking
