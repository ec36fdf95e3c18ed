#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "hal/camera.h"
#include "hal/outputs/open_output.h"
#include "pipeline/runtime/output_stage.h"
#include "pipeline/runtime/paint_stage.h"

namespace pleinair::app {

// What [runtime] means to the live chain.

/// The names of the engine's levels of quality, the best first.
std::vector<std::string> qualityNames();

/// How costs and latency are kept for a camera's stream.
runtime::PaintStageOptions paintRules(const RuntimeSettings& settings,
                                      const hal::StreamFormat& stream);

/// How an output named `name` is fed: files get each picture as it comes, others at its due time;
/// what is a device is opened again after it has failed.
runtime::OutputStageOptions outputRules(const std::string& name,
                                        const hal::OutputOptions& outputOptions,
                                        const RuntimeSettings& settings,
                                        const hal::StreamFormat& stream);

}  // namespace pleinair::app
