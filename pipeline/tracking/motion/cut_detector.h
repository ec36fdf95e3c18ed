#pragma once

#include <array>
#include <cstddef>

#include <glm/vec2.hpp>

#include "pipeline/tracking/motion/view_comparison.h"

namespace pleinair::tracking {

class LumaPyramid;

/// An image of a few hundred pixels, for finding out whether two frames show the same scene and how
/// far they are apart.
class Thumbnail {
 public:
  void load(const LumaPyramid& pyramid);
  /// Standard deviation in grey levels; close to zero for a covered lens.
  double contrast() const;
  double mean() const;  ///< grey levels
  /// The part of the cells in which another thumbnail has changed by no more than the light, and
  /// which are not black.
  double unchangedPart(const Thumbnail& other) const;

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

/// Tells a new view from one that has moved, been covered or lit differently. A frame is a cut if
/// features are lost and hardly any of the blocks with texture are seen again, forwards or
/// backwards in time, under one motion that a camera can make between two frames (ViewComparison).
/// Where blocks cannot tell, for want of texture or because it repeats, thumbnails that match keep
/// the view, and so does a bare wall of which most is as it was. docs/decisions/0025-cuts.md has
/// the margins. One thread at a time.
class CutDetector {
 public:
  /// Takes the next frame, the part of the previous frame's features that were found in it, and the
  /// noise of the pyramid's pixels (levels). The first frame is a cut. Frames without contrast
  /// count as a cut only after several in a row.
  bool isCut(const LumaPyramid& current, double foundShare, double noise);
  /// Whether the last frame was blank, as of a covered lens.
  bool isBlank() const { return blankFrames_ > 0; }
  /// Treats the next frame as the first one.
  void reset() { hasSeen_ = false; }

 private:
  struct Frame {
    Thumbnail thumbnail;
    ViewComparison::View view;
  };
  enum class Likeness { kSameView, kOtherView, kBlank };
  Likeness compare(double foundShare, double noise);

  Frame seen_;  // the last frame with contrast, or of a bare wall
  Frame current_;
  ViewComparison comparison_;
  bool hasSeen_ = false;
  int blankFrames_ = 0;
};

}  // namespace pleinair::tracking
