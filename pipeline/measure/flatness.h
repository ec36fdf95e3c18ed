#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// The texture of a grey picture within the border, whatever it shows.
struct TextureStatistics {
  static constexpr int kLevels = 16;
  static constexpr std::array kDistances{1, 2, 4, 8};
  /// For each distance: how often two levels lie so far from each other, over the directions 0°,
  /// 45°, 90° and 135°, either way round; sums to 1 (Haralick, 1973).
  std::array<cv::Matx<double, kLevels, kLevels>, kDistances.size()> cooccurrences;
  /// Power of the high pass by frequency, of equal steps up to half a cycle a px; sums to 1. Of the
  /// largest square in the middle, under a Hann window.
  std::vector<double> spectrum;

  TextureStatistics& operator+=(const TextureStatistics& other);
};

TextureStatistics textureOf(const cv::Mat1f& grey);

/// How two textures differ.
struct TextureDifference {
  /// The average co-occurrence error (Copeland et al., 2001): the share of pairs that would have to
  /// change their levels, mean over the distances; in [0, 1].
  double cooccurrenceError = 0;
  /// Of the mean frequency of the second by the first: 1 where marks keep their size, 1/scale where
  /// they grow with the picture.
  double frequencyRatio = 1;
  double spectrumError = 0;  ///< the share of power at another frequency
};

TextureDifference differenceOf(const TextureStatistics& a, const TextureStatistics& b);

/// Whether marks keep their size on the screen while the camera moves in or out: the first frames
/// of a sequence against its last.
struct Flatness {
  double scale = 1;  ///< how much larger the picture is at the end
  TextureDifference painting, input;
};

/// Gathers what flatness needs, while the frames go by.
class FlatnessMeasures {
 public:
  void add(const cv::Mat3f& input, const cv::Mat3f& output);
  /// By how much the picture grows along a motion; called for motions that follow one another.
  void follow(const MotionMap& motion);
  /// Nothing where the scale changes too little to tell, or there were too few frames.
  std::optional<Flatness> total() const;
  double scale() const;

  /// Below this, and above its inverse, marks hardly change their size.
  static constexpr double kLeastScale = 1.15;

 private:
  struct Pair {
    TextureStatistics input, output;
  };
  std::vector<Pair> first_;
  std::deque<Pair> last_;
  double logScale_ = 0;
};

}  // namespace pleinair::measure
