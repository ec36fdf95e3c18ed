#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/image.h"
#include "hal/pixel_format.h"
#include "pipeline/measure/anchor_measures.h"
#include "pipeline/measure/flatness.h"
#include "pipeline/measure/gates.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/label_measures.h"
#include "pipeline/measure/measures.h"
#include "pipeline/measure/model_gates.h"
#include "pipeline/measure/mover_measures.h"
#include "pipeline/measure/negative_controls.h"

namespace pleinair::measure {

/// Readings of one frame of the painting, for plots.
struct FrameValues {
  std::uint64_t frame = 0;
  Measures painting, input;
  std::optional<AnchorFrame> anchors;
  std::optional<double> labelIou;  ///< of the painter's labels of movers with the true masks
};

/// A frame in which much changed along the motion, for people to look at: its input, its painting,
/// and the difference to the one two frames before.
struct WorstFrame {
  std::uint64_t frame = 0;
  double ew2 = 0;
  hal::Image input, output, difference;
  double differenceGain = 1;  ///< amplification with which the difference is shown
};

/// All results of one measured sequence.
struct Report {
  std::string style;
  std::string settings;  ///< "look oil, 640x480"
  std::string input;
  std::string motion;  ///< "pan by …", or that it is unknown
  MotionKind motionKind = MotionKind::kNone;
  hal::FrameSize size;
  std::uint64_t settled = 0;  ///< frames painted before measuring began
  std::uint64_t frames = 0;   ///< measured frames
  std::uint64_t stillFrames = 0;
  double stillNoise = 0;  ///< levels

  PerSubject<Measures> measures;
  std::optional<Flatness> flatness;
  std::optional<AnchorSummary> inside;       ///< of the moving sequence
  std::optional<AnchorSummary> insideStill;  ///< of the still scene
  /// These three are there if the camera stands; the labels, if the painter has any.
  std::optional<MoverReport> movers;
  std::optional<LabelSummary> labels;  ///< where true masks are known
  std::optional<double> labelFlipsOnStillPercent;
  std::optional<ModelReport> models;  ///< if the pictures show virtual models
  std::vector<FrameValues> overTime;
  std::vector<WorstFrame> worst;  ///< worst first
  std::vector<Verdict> controls;
  std::vector<Verdict> gates;
  std::vector<std::string> notices;
  std::vector<std::string> leftOut;  ///< measures that are missing, and the reasons

  /// Whether every evaluated control reads as it must.
  bool areControlsValid() const;
  /// Whether every gate was measured and passed.
  bool areGatesPassed() const;
};

/// Name of a subject in tables.
std::string nameOf(Subject subject, const Report& report);
std::string descriptionOf(Region region);

// Sentences that reports of every kind share.
std::string framesText(const Report& report);
std::vector<std::string> insideLines(const Report& report);
std::vector<std::string> flatnessLines(const Report& report);
std::vector<std::string> moverLines(const Report& report);
std::vector<std::string> labelLines(const Report& report);
std::vector<std::string> anchorsOnModelsLines(const Report& report);
std::vector<std::string> modelLines(const Report& report);

/// The report as text for a terminal.
std::string reportText(const Report& report);
/// The report as JSON, with all figures.
std::string reportJson(const Report& report);
/// The report as one self-contained HTML page: tables, plots over time, the worst frames.
std::string reportHtml(const Report& report);

}  // namespace pleinair::measure
