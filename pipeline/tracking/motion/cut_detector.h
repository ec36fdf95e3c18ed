#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <glm/vec2.hpp>

namespace pleinair::tracking {

class LumaPyramid;

/// An image of a few hundred pixels, for finding out whether two frames show the same scene and how
/// far they are apart.
class Thumbnail {
 public:
  void load(const LumaPyramid& pyramid);
  /// Standard deviation in grey levels; close to zero for a covered lens.
  double contrast() const;

  /// The best match of another thumbnail over all shifts by up to a quarter of the sides.
  struct Match {
    glm::dvec2 shift{0.0};     ///< shift of the other thumbnail, in parts of the sides
    double correlation = 0.0;  ///< correlation of the overlap; 1 where only gain and offset differ
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

/// Tells a new scene from one that has moved, been covered or lit differently: a new scene loses
/// the features and also changes the thumbnail. One thread at a time.
class CutDetector {
 public:
  /// Takes the next frame and the part of the previous frame's features that were found in it. The
  /// first frame is a cut. Frames without contrast count as a cut only after several in a row.
  bool isCut(const LumaPyramid& current, double foundShare);
  /// Treats the next frame as the first one.
  void reset() { seen_.reset(); }

 private:
  std::optional<Thumbnail> seen_;  // of the last frame with contrast
  Thumbnail current_;
  int blankFrames_ = 0;
};

}  // namespace pleinair::tracking
