#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "hal/pixel_format.h"
#include "pipeline/measure/controls.h"
#include "pipeline/measure/measures.h"
#include "pipeline/measure/true_motion.h"
#include "pipeline/measure/verdict.h"

namespace pleinair::measure {

/// All that is told of one measured sequence.
struct Report {
  std::string style;
  std::string settings;  ///< "look default, 640x480"
  std::string input;
  std::string motion;  ///< "pan by …", or that it is not known
  MotionKind motionKind = MotionKind::kNone;
  hal::FrameSize size;
  std::uint64_t settled = 0;  ///< frames that were painted before measuring began
  std::uint64_t frames = 0;   ///< that were measured
  std::uint64_t stillFrames = 0;
  double stillNoise = 0;  ///< levels

  PerSubject<Measures> measures;
  std::vector<Verdict> controls;
  std::vector<Verdict> gates;
  std::vector<std::string> notices;
  std::vector<std::string> leftOut;  ///< what was not measured, and why

  /// Whether every control that could be told reads as it must.
  bool areControlsSound() const;
  /// Whether every gate was measured and passed.
  bool areGatesPassed() const;
};

/// What a subject is called in tables.
std::string nameOf(Subject subject, const Report& report);

/// The report as lines for a terminal.
std::string reportText(const Report& report);

}  // namespace pleinair::measure
