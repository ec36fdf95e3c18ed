#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "hal/captured_frame.h"
#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/measure/input/measured_input.h"
#include "pipeline/measure/input/model_motion.h"
#include "pipeline/measure/measurement_report.h"
#include "pipeline/styles/coherence_gates.h"

namespace pleinair::measure {

/// A painted frame and its source, both RGB8 of one size.
struct PaintedFrame {
  /// What the painting is compared with: the camera's picture, with virtual models in it if there
  /// are any.
  hal::Image input;
  hal::Image output;
  std::vector<marks::Anchor> anchors;  ///< anchors of its marks; empty if there are none
  /// Which places the painter takes for movers: grey, 255 on them, at half the size. Nothing if it
  /// tells no movers.
  std::optional<hal::Image> movers = {};
  /// Which points of virtual models it shows: in all frames, or in none.
  std::optional<PaintedModels> models = {};
  hal::Image camera = {};  ///< the camera's picture alone, where there are `models`
};

/// The subject of a measurement: the engine with a style, or a filter to compare with. One thread.
class MeasuredPainter {
 public:
  virtual ~MeasuredPainter() = default;
  MeasuredPainter() = default;
  MeasuredPainter(const MeasuredPainter&) = delete;
  MeasuredPainter& operator=(const MeasuredPainter&) = delete;

  /// Paints the next frame. An error ends the measurement.
  virtual hal::Result<PaintedFrame> paint(const hal::CapturedFrame& frame) = 0;
  /// Forgets all previous frames, as after a cut.
  virtual void reset() = 0;
};

struct MeasurementOptions {
  std::string style;
  styles::CoherenceGates coherence = {};  ///< the style's
  std::string settings;
  /// Largest number of measured frames; default: the whole input.
  std::optional<std::uint64_t> frames;
  std::uint64_t settle = 0;        ///< frames painted before measuring begins
  std::uint64_t stillFrames = 30;  ///< frames of the still scene; 0: no still scene
  std::uint64_t stillSettle = 30;  ///< frames painted before these
  double stillNoiseLevels = 2.0;
  /// The camera stands: also measure what moves before it (MoverMeasures). Only the gates that hold
  /// under any motion are judged beside those.
  bool isStanding = false;
  bool isOnPaper = false;  ///< the look is one of the style's CoherenceGates::paperLooks
  /// Called after each frame; returning false aborts.
  std::function<bool()> goesOn = [] { return true; };
};

/// Number of frames that will be painted, if the input knows its length.
std::optional<std::uint64_t> framesToPaint(const MeasuredInput& input,
                                           const MeasurementOptions& options);

/// Paints the input, then a still of its first measured frame under fresh noise. Measures both and
/// the negative controls, and evaluates the gates. Returns nothing if it was aborted. Errors: the
/// input's, the painter's, and kInvalidInput (frames too small or too few).
hal::Result<std::optional<Report>> measure(MeasuredInput& input, MeasuredPainter& painter,
                                           const MeasurementOptions& options);

}  // namespace pleinair::measure
