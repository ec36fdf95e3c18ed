#pragma once

#include <optional>
#include <vector>

#include "pipeline/measure/gates.h"
#include "pipeline/measure/label_measures.h"
#include "pipeline/measure/mover_measures.h"

namespace pleinair::measure {

/// The gates of movers. `isOnPaper`: on bare paper, LOST says nothing.
std::vector<Verdict> moverVerdicts(const MoverReport& movers, bool isOnPaper);
/// Whether the controls read as they must.
std::vector<Verdict> moverControlVerdicts(const MoverReport& movers);

/// The gates of labels, of a sequence and of a still scene (percent of flips).
std::vector<Verdict> labelVerdicts(const std::optional<LabelSummary>& labels,
                                   std::optional<double> stillFlipsPercent);
/// Whether the control reads as it must.
std::vector<Verdict> labelControlVerdicts(const LabelSummary& labels);

}  // namespace pleinair::measure
