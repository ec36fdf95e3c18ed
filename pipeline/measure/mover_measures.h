#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/measure/mover_motion.h"

namespace pleinair::measure {

/// How a painting treats what moves by itself before a standing camera (docs/measuring.md). A value
/// is missing where nothing of its kind was seen.
struct MoverSummary {
  double coveredPercent = 0;  ///< of all pixels within the border
  /// STILL: the share of pixels whose painting changes by more than 8 levels from one frame to the
  /// next, among those away from movers whose input does not, and has not by itself for a second.
  std::optional<double> stillPercent;
  /// FOLLOW: how far the painting is, 0.3 s after the input has changed at once away from movers,
  /// from what it comes to, over how far it was before.
  std::optional<double> follow;
  /// RETURN: how far the painting differs, 1 s after a mover has left, from that before it came;
  /// levels, where the input came back to within 4.
  std::optional<double> returnLevels;
  /// GHOST: the same after 0.2 s, over the mover's contrast.
  std::optional<double> ghost;
  /// LOST: of the mover's pixels, those whose painting is nearer to the painted ground than to the
  /// camera's picture in the painting's palette.
  std::optional<double> lostPercent;
  /// REMAINS: where a mover stood in the first frame, from 1 s after it has left, the pixels whose
  /// painting is nearer to that of the first frame than to the camera's picture.
  std::optional<double> remainsPercent;
};

/// The same of the painting and of controls.
struct MoverReport {
  bool areMasksTrue = false;  ///< of the input; else they are found, and motion is estimated
  MoverSummary painting;
  PerSubject<MoverMotionSummary> alongMotion;
  /// A painter that averages its input over the time constant of strokes, and so leaves trails.
  MoverSummary averaging;
  /// By how much more of the input's own pixels change away from movers under displaced masks
  /// (mover_masks.h) than under the right ones: movers are then beside them.
  std::optional<double> displacedStillPercent;
};

/// A frame and its painting, RGB8 of one size, with what is known of its movers.
struct MoverObservation {
  hal::TimePoint time;
  const hal::Image& input;
  const hal::Image& output;
  cv::Mat1b trueMovers = {};              ///< 255 on them; empty if they are not known
  const MotionMap* trueMotion = nullptr;  ///< from the frame two before; null: none, or not known
};

/// Collects a sequence before a standing camera. Movers whose masks are not given are found
/// (findMovers()), and their motion is estimated (standingMotion()). Keeps all frames: six bytes a
/// pixel each, seven with masks, ten while they are evaluated. One thread.
class MoverMeasures {
 public:
  /// Takes the next frame. Precondition: masks are given for all frames or for none.
  void add(const MoverObservation& frame);
  /// The mask of the last frame. Precondition: masks are given.
  const cv::Mat1b& lastTrueMovers() const { return trueMovers_.back(); }
  /// Nothing if there are fewer than two frames.
  std::optional<MoverReport> total() const;

 private:
  std::vector<hal::TimePoint> times_;
  std::vector<cv::Mat3b> inputs_;
  std::vector<cv::Mat3b> outputs_;
  std::vector<cv::Mat1b> trueMovers_;
  std::optional<MoverMotion> motion_;  ///< of true movers
};

}  // namespace pleinair::measure
