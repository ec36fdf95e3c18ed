#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <opencv2/core.hpp>

#include "pipeline/measure/input/motion_map.h"
#include "pipeline/measure/mean.h"
#include "pipeline/measure/negative_controls.h"

namespace pleinair::measure {

/// How well marks follow a mover. A value is missing where nothing was compared.
struct MoverMotionSummary {
  std::optional<double> nHw2;            ///< MOVER nHW2
  std::optional<double> popPercent;      ///< MOVER POP
  std::optional<double> seamPopPercent;  ///< SEAM POP
  /// Both of pictures smoothed by 2 px.
  std::optional<double> smoothPopPercent;
  std::optional<double> smoothSeamPopPercent;
};

/// nHW2 and POP (image_measures.h) along the motion over two frames, on movers and in the seam,
/// which is 8 px on both sides of their border; of a painting and of the controls. Both leave out
/// what is hidden and what is within 3 px of a motion boundary (15 px for nHW2), as everywhere.
class MoverMotion {
 public:
  explicit MoverMotion(cv::Size frame) : controls_(frame) {}

  /// Takes the next frame: RGB in [0, 1], with its mask of movers. `motion`: from the frame two
  /// before to this one; null if there is none. Precondition: it is a field and no shift.
  void add(const cv::Mat3f& input, const cv::Mat3f& output, const cv::Mat1b& movers,
           const MotionMap* motion);
  MoverMotionSummary of(Subject subject) const;

 private:
  struct Recent {
    PerSubject<cv::Mat3f> pictures;  ///< empty where neither this frame nor the one two before is
                                     ///< compared
    cv::Mat1b movers;
    bool hasMovers = false;
  };
  struct Sums {
    Mean error;
    Mean misaligned;
    Mean popped;
    Mean seamPopped;
    Mean smoothPopped;
    Mean smoothSeamPopped;
  };
  void compare(Subject subject, const Recent& earlier, const Recent& later,
               const MotionMap& motion);

  ControlPainter controls_;
  std::deque<Recent> recent_;  ///< three at most, the newest last
  PerSubject<Sums> sums_;
  std::uint64_t frames_ = 0;
};

}  // namespace pleinair::measure
