#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/measures.h"

namespace pleinair::measure {

/// The two lags that frames are compared at.
inline constexpr std::size_t kShortLag = 2;
inline constexpr std::size_t kLongLag = 10;

/// How the picture moved to this frame from those before; null where there was no such frame, or
/// where it is not known: then SCR takes it that everything moves.
struct MotionToHere {
  const MotionMap* shortLag = nullptr;
  const MotionMap* longLag = nullptr;
};

/// What a sequence of one output reads, frame by frame, and in all. Keeps the frames that the lags
/// need and no more: some 30 floats a pixel.
class OutputMeasures {
 public:
  /// What one frame brought. `popped` and the like compare it with the frame two before.
  struct Frame {
    Mean error;            ///< of EW2, not yet times 1000
    Mean highPassError;    ///< of nHW2
    Mean misalignedError;  ///< likewise, laid wrong
    Mean popped;
    Mean lasting;
    Mean screen;
    Mean deviation;
    Mean detail;  ///< mean square of the high pass
  };

  /// The next frame. Precondition: of the size of those before.
  void add(const cv::Mat3f& output, const cv::Mat3f& input, const MotionToHere& motion);

  const std::vector<Frame>& frames() const { return frames_; }
  /// What one of them reads beside the input's, or sums over frames do; all but xFLK.
  static Measures valuesOf(const Frame& frame, const Frame& input);
  /// The sums over all frames.
  Frame total() const;

  /// Of the last frame, against two before; empty where there is none.
  cv::Mat3f lastDifference() const;

 private:
  struct Recent {
    cv::Mat3f picture, highPass;
  };
  void compareShortLag(Frame& frame, const MotionMap& motion);
  void compareLongLag(Frame& frame, const MotionMap* motion);

  std::vector<Frame> frames_;
  std::deque<Recent> recent_;    ///< kShortLag + 1 at most, the newest last
  std::deque<cv::Mat1f> greys_;  ///< kLongLag + 1 at most
  cv::Mat3f difference_;
};

}  // namespace pleinair::measure
