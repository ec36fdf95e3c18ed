#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/captured_frame.h"
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/marks/anchor.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/report/report.h"
#include "pipeline/styles/coherence_gates.h"

namespace pleinair::measure {

/// A frame as it was painted, and what was painted from, both RGB8 of the same size.
struct PaintedFrame {
  hal::Image input;
  hal::Image output;
  std::vector<marks::Anchor> anchors;  ///< of its marks; empty where there are none
};

/// What is measured: the engine with a style, or a filter that it is compared with. One thread.
class MeasuredPainter {
 public:
  virtual ~MeasuredPainter() = default;
  MeasuredPainter() = default;
  MeasuredPainter(const MeasuredPainter&) = delete;
  MeasuredPainter& operator=(const MeasuredPainter&) = delete;

  /// The next frame. Errors: why it was not painted, with which the measurement ends.
  virtual hal::Result<PaintedFrame> paint(const hal::CapturedFrame& frame) = 0;
  /// Forgets the past, as after a cut.
  virtual void reset() = 0;
};

struct MeasurementOptions {
  std::string style;
  styles::CoherenceGates coherence = {};  ///< the style's
  std::string settings;
  std::optional<std::uint64_t> frames;  ///< measured at the most; default: all that the input has
  std::uint64_t settle = 0;             ///< painted before that
  std::uint64_t stillFrames = 30;       ///< of the still scene; 0: leaves it out
  std::uint64_t stillSettle = 30;       ///< painted before those
  double stillNoiseLevels = 2.0;
  /// Called after each frame; false breaks off.
  std::function<bool()> goesOn = [] { return true; };
};

/// Frames that will be painted in all, where the input says how many it has.
std::optional<std::uint64_t> framesToPaint(const MeasuredInput& input,
                                           const MeasurementOptions& options);

/// Paints the input and then a still of its first measured frame under fresh noise, measures both
/// and the controls, and judges. Nothing where it was broken off. Errors: the input's, the
/// painter's, and kInvalidInput (frames too small or too few).
hal::Result<std::optional<Report>> measure(MeasuredInput& input, MeasuredPainter& painter,
                                           const MeasurementOptions& options);

}  // namespace pleinair::measure
