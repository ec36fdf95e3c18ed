#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "firmware_app/configuration.h"
#include "pipeline/measure/moved_photograph.h"

namespace pleinair::app {

struct MeasureOptions {
  ConfigurationRequest configuration;
  std::optional<std::filesystem::path> input;   ///< default: the synthetic camera
  std::optional<std::filesystem::path> motion;  ///< how a recording moves
  measure::PhotographMotion photograph;         ///< how a photograph is moved
  std::string movedBy;                          ///< "--pan", "--still" …; empty: by none
  double noiseLevels = 2.0;
  std::optional<std::uint64_t> frames;
  std::optional<std::uint64_t> settle;
  bool gates = false;
  std::optional<std::filesystem::path> json;
  std::optional<std::filesystem::path> html;
};

/// Paints a sequence of which the motion is known and prints how coherent the painting is:
/// `pleinair measure`. Throws hal::StartupError and config::ConfigError. Returns the exit status:
/// 0; 1 where a gate was asked for and not passed; 2 where the controls do not read as they must;
/// or 128 + the signal that broke it off.
int runMeasure(const MeasureOptions& options);

}  // namespace pleinair::app
