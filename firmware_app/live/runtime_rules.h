#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "hal/camera.h"
#include "hal/outputs/registry.h"
#include "pipeline/runtime/control/heat_guard.h"
#include "pipeline/runtime/output/output_stage.h"
#include "pipeline/runtime/paint/paint_stage.h"

namespace pleinair::app {

// Converts [runtime] to options of the live pipeline.

/// The names of the engine's quality levels, best first.
std::vector<std::string> qualityNames();

/// Rules of quality, latency and time budget for a camera's stream.
runtime::PaintStageOptions paintRules(const RuntimeSettings& settings,
                                      const hal::StreamFormat& stream);

/// Rules of what heat does to the quality.
runtime::HeatRules heatRules(const RuntimeSettings& settings);

/// Opens an output, not started, by its target, as hal::openOutput() does.
using OutputOpener =
    std::function<hal::Result<std::unique_ptr<hal::Output>>(const std::string& target)>;

/// Options of the output stage of a target, from the traits of its kind. Throws hal::Failure for a
/// target of no kind.
runtime::OutputStageOptions outputRules(const std::string& target, const OutputOpener& open,
                                        const RuntimeSettings& settings,
                                        const hal::StreamFormat& stream);

}  // namespace pleinair::app
