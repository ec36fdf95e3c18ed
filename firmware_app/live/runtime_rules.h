#pragma once

#include <string>
#include <vector>

#include "firmware_app/config/configuration.h"
#include "hal/camera.h"
#include "hal/outputs/registry.h"
#include "pipeline/runtime/output_stage.h"
#include "pipeline/runtime/paint_stage.h"

namespace pleinair::app {

// What [runtime] means to the live chain.

/// The names of the engine's levels of quality, the best first.
std::vector<std::string> qualityNames();

/// How costs and latency are kept for a camera's stream.
runtime::PaintStageOptions paintRules(const RuntimeSettings& settings,
                                      const hal::StreamFormat& stream);

/// How the output of a target is fed, by the traits of its kind. Throws hal::Failure where it is of
/// none.
runtime::OutputStageOptions outputRules(const std::string& target,
                                        const hal::OutputOptionsByKind& outputOptions,
                                        const RuntimeSettings& settings,
                                        const hal::StreamFormat& stream);

}  // namespace pleinair::app
