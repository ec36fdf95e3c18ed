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

/// The two lags at which frames are compared.
inline constexpr std::size_t kShortLag = 2;
inline constexpr std::size_t kLongLag = 10;

/// Motion to this frame from earlier ones. Null if there is no such frame or its motion is unknown;
/// SCR then assumes that everything moves.
struct MotionFromPast {
  const MotionMap* shortLag = nullptr;
  const MotionMap* longLag = nullptr;
};

/// Measures of one output over a sequence, per frame and in total. Keeps only the frames that the
/// lags need: about 30 floats per pixel.
class OutputMeasures {
 public:
  /// Measures of one frame. `popped` and the following compare it with the frame two before.
  struct Frame {
    Mean error;            ///< of EW2, before the factor 1000
    Mean highPassError;    ///< of nHW2
    Mean misalignedError;  ///< the same, misaligned on purpose
    Mean popped;
    Mean lasting;
    Mean screen;
    Mean deviation;
    Mean detail;  ///< mean square of the high pass
  };

  /// Takes the next frame. Precondition: it has the size of the previous ones.
  void add(const cv::Mat3f& output, const cv::Mat3f& input, const MotionFromPast& motion);

  const std::vector<Frame>& frames() const { return frames_; }
  /// Measures of one frame, or of sums over frames, relative to the input's; all but xFLK.
  static Measures valuesOf(const Frame& frame, const Frame& input);
  /// The sums over all frames.
  Frame total() const;

  /// Difference of the last frame to the one two before; empty if there is none.
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
