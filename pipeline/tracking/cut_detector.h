#pragma once

#include <optional>

#include "pipeline/tracking/thumbnail.h"

namespace pleinair::tracking {

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
