#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <glm/vec2.hpp>

namespace pleinair::tracking {

class LumaPyramid;

/// A picture of a few hundred pixels: what is left of it for finding out whether two frames show
/// the same scene, and about how far apart.
class Thumbnail {
 public:
  void load(const LumaPyramid& pyramid);
  /// Standard deviation, grey levels: next to nothing of a covered lens.
  double contrast() const;

  /// Where another one fits best, of all shifts by up to a quarter of the sides.
  struct Match {
    glm::dvec2 shift{0.0};     ///< of the other, in parts of the sides
    double correlation = 0.0;  ///< of what overlaps, 1: the same but for gain and offset
  };
  Match match(const Thumbnail& other) const;

 private:
  static constexpr int kWidth = 32;
  static constexpr int kHeight = 24;
  double correlation(const Thumbnail& other, int dx, int dy) const;
  float at(int x, int y) const {
    return values_[static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x)];
  }
  std::array<float, static_cast<std::size_t>(kWidth) * kHeight> values_{};
};

class LumaPyramid;

/// Tells another scene from one that has only moved, been covered or lit: its features are lost,
/// and the whole looks different as well. One thread at a time.
class CutDetector {
 public:
  /// Takes the next frame and the part of the features of the one before that were found in it.
  /// The first frame is a cut. A frame without contrast is one only when they go on.
  bool isCut(const LumaPyramid& now, double foundShare);
  /// The next frame is a first one.
  void reset() { seen_.reset(); }

 private:
  std::optional<Thumbnail> seen_;  // the last that showed something
  Thumbnail now_;
  int blankFrames_ = 0;
};

}  // namespace pleinair::tracking
