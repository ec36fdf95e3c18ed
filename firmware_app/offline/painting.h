#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "config/parameter_values.h"
#include "hal/camera.h"
#include "hal/media/picture_encoder.h"
#include "hal/outputs/movie/movie_output.h"
#include "hal/pixel_format.h"
#include "pipeline/engine/painter.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/description/scene.h"

namespace pleinair::app {

/// The output that means Y4M on standard output; the summary then goes to standard error.
inline constexpr const char* kStandardOutput = "-";

/// The options of one run.
struct PaintingOptions {
  std::filesystem::path output;
  hal::MovieOptions movie;           ///< where the output is one
  hal::PictureFileOptions pictures;  ///< where it is pictures
  std::string style = "watercolor";
  std::optional<hal::FrameSize> size;                 ///< default: the camera's
  std::optional<std::uint64_t> frames;                ///< default: all
  std::string view;                                   ///< a debug view; empty: the finished image
  std::optional<config::ParameterValues> parameters;  ///< of the style; default: the style's own
  std::optional<std::filesystem::path> poses;
  std::optional<std::filesystem::path> contactSheet;
  std::filesystem::path shaderDirectory;
  bool isCameraMounted = false;  ///< PainterOptions::isCameraMounted
};

/// The parameters that a painting begins with, live or not: those of the options, or else the
/// style's own, and the options' view. Throws hal::Failure (kInvalidArgument) for an unknown view,
/// with all names.
PaintParameters startParameters(const PaintingOptions& options);

/// Tells of a movie of an odd side, whose file is one px longer (openMovieOutput()).
std::optional<std::string> evenSizeNotice(const std::filesystem::path& output, hal::FrameSize size);

/// Passes every frame of a camera through a Painter to an output: the common part of `render` and
/// `record`.
struct PaintingJob {
  hal::Camera* camera = nullptr;  ///< stopped; delivers stepped
  hal::StreamRequest request;     ///< of a device
  /// A device's clock; null for a camera that is never silent, which is not polled for signals.
  const hal::Clock* clock = nullptr;
  PaintingOptions options;
  scene::Scene scene;
  std::optional<std::size_t> machine;  ///< of the scene, that an overlay is drawn over
  /// The overlay at a time of the recording, for pictures of that size; null: none.
  std::function<std::shared_ptr<const overlay::OverlayContent>(hal::Duration, hal::FrameSize)>
      overlay;
  std::string progressVerb;  ///< verb of the progress line: "painting"
  std::string summaryVerb;   ///< verb of the summary: "painted"
};

/// Runs the job with progress, and a summary on standard output. Throws hal::Failure and
/// config::ConfigError. Returns the exit status: 0, or 128 + the signal that interrupted it, with a
/// line on standard error.
///
/// A movie, a single picture, poses and a contact sheet take their names once all of them are
/// complete. After a signal, or where the camera is lost, they are completed with the frames so far
/// and kept; after another failure (a full disk, the GPU) they are not. A folder or a pattern keeps
/// the complete frames written so far. No partial file ever has a final name.
int runPainting(const PaintingJob& job);

}  // namespace pleinair::app
