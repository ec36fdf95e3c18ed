#pragma once

#include <optional>
#include <vector>

#include "pipeline/measure/gates.h"
#include "pipeline/measure/label_measures.h"
#include "pipeline/measure/mover_measures.h"

namespace pleinair::measure {

/// The kind of a style's marks, as far as it decides how they are judged on movers.
struct MoverMarks {
  bool areOnPaper = false;  ///< bare paper is like no picture: LOST and REMAINS say nothing
  /// Thin lines change by more than POP's 24 levels when they move by a part of a pixel: POP is
  /// that of smoothed pictures.
  bool areLines = false;
};

/// The gates of movers.
std::vector<Verdict> moverVerdicts(const MoverReport& movers, MoverMarks marks);
/// Whether the controls read as they must.
std::vector<Verdict> moverControlVerdicts(const MoverReport& movers, MoverMarks marks);

/// The gates of labels, of a sequence and of a still scene (percent of flips).
std::vector<Verdict> labelVerdicts(const std::optional<LabelSummary>& labels,
                                   std::optional<double> stillFlipsPercent);
/// Whether the control reads as it must.
std::vector<Verdict> labelControlVerdicts(const LabelSummary& labels);

}  // namespace pleinair::measure
