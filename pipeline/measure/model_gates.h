#pragma once

#include <optional>
#include <vector>

#include "pipeline/measure/gates.h"
#include "pipeline/measure/model_anchors.h"
#include "pipeline/measure/model_regions.h"
#include "pipeline/styles/coherence_gates.h"

namespace pleinair::measure {

/// How coherent pictures with virtual models are painted (docs/measuring.md).
struct ModelReport {
  PerRegion<PerSubject<RegionSummary>> regions;
  std::optional<double> forgettingRatio;      ///< ModelRegions::forgettingRatio()
  std::optional<ModelAnchorSummary> anchors;  ///< nothing if none was on a model
};

/// The gates of regions, and of anchors on models for styles that hold theirs. nHW2 and S10 are
/// judged by the style's own gates under any known motion; 0.2 and 80 % where it has none.
std::vector<Verdict> modelVerdicts(const ModelReport& models, const styles::CoherenceGates& gates);
/// Whether the controls read as they must.
std::vector<Verdict> modelControlVerdicts(const ModelReport& models,
                                          const styles::CoherenceGates& gates);

}  // namespace pleinair::measure
