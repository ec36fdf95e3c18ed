#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "config/parameter_values.h"
#include "hal/camera.h"
#include "hal/pixel_format.h"
#include "pipeline/engine/painter.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// What the user chooses.
struct PaintingOptions {
  std::filesystem::path output;
  std::string style = "watercolor";
  std::optional<hal::FrameSize> size;                 ///< default: the camera's
  std::optional<std::uint64_t> frames;                ///< default: all
  std::string view;                                   ///< empty: the finished picture
  std::optional<config::ParameterValues> parameters;  ///< of the style; default: its own
  std::optional<std::filesystem::path> poses;
  std::optional<std::filesystem::path> contactSheet;
  std::filesystem::path shaderDirectory;
};

/// What a painting begins with, live or not: the options' parameters, or else the style's own, and
/// their view. Throws hal::Failure (kInvalidArgument) for an unknown view, with all names.
PaintParameters startParameters(const PaintingOptions& options);

/// Every frame of a camera through a Painter to an output: what `render` and `record` have in
/// common.
struct PaintingJob {
  hal::Camera* camera = nullptr;  ///< stopped; delivers stepped
  hal::StreamRequest request;     ///< of a device
  PaintingOptions options;
  scene::Scene scene;
  std::string doing;  ///< for the progress: "painting"
  std::string done;   ///< for the summary: "painted"
};

/// Runs the job with progress, and a summary on standard output. Throws hal::Failure and
/// config::ConfigError. Returns the exit status: 0, or 128 + the signal that broke it off, with a
/// line on standard error.
///
/// A movie, a single picture, poses and a contact sheet stand under their names once all of them
/// are whole, and not at all after a failure or a signal. A folder or a pattern keeps the whole
/// frames that were written so far. Nothing partial stands under any name.
int runPainting(const PaintingJob& job);

}  // namespace pleinair::app
