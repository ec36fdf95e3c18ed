#pragma once

#include <array>
#include <deque>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"

namespace pleinair::measure {

/// Texture of a grey image within the border, independent of its subject.
struct TextureStatistics {
  static constexpr int kLevels = 16;
  static constexpr std::array kDistances{1, 2, 4, 8};
  /// Per distance: frequencies of pairs of levels at that distance, over the directions 0°, 45°,
  /// 90° and 135°, symmetric; sums to 1 (Haralick, 1973).
  std::array<cv::Matx<double, kLevels, kLevels>, kDistances.size()> cooccurrences;
  /// Power of the high pass by frequency, in equal bins up to half a cycle per px; sums to 1. Over
  /// the largest centred square, with a Hann window.
  std::vector<double> spectrum;

  TextureStatistics& operator+=(const TextureStatistics& other);
};

TextureStatistics textureOf(const cv::Mat1f& grey);

/// Difference of two textures.
struct TextureDifference {
  /// Average co-occurrence error (Copeland et al., 2001): the share of pairs that would have to
  /// change their levels, averaged over the distances; in [0, 1].
  double cooccurrenceError = 0;
  /// Mean frequency of the second over that of the first: 1 where marks keep their size, 1/scale
  /// where they scale with the image.
  double frequencyRatio = 1;
  double spectrumError = 0;  ///< share of power at another frequency
};

TextureDifference differenceOf(const TextureStatistics& a, const TextureStatistics& b);

/// Whether marks keep their size on the screen while the camera moves in or out: compares the first
/// frames of a sequence with its last.
struct Flatness {
  double scale = 1;  ///< scale of the image at the end, relative to the start
  TextureDifference painting, input;
};

/// Collects the statistics for Flatness frame by frame.
class FlatnessMeasures {
 public:
  void add(const cv::Mat3f& input, const cv::Mat3f& output);
  /// Accumulates the scale of a motion; call it for consecutive motions.
  void follow(const MotionMap& motion);
  /// Nothing where the scale changes too little or there were too few frames.
  std::optional<Flatness> total() const;
  double scale() const;

  /// Below this, and above its inverse, marks hardly change their size.
  static constexpr double kMinScale = 1.15;

 private:
  struct Pair {
    TextureStatistics input, output;
  };
  std::vector<Pair> first_;
  std::deque<Pair> last_;
  double logScale_ = 0;
};

}  // namespace pleinair::measure
