#include "firmware_app/live/open_camera.h"

#include <filesystem>
#include <system_error>

#include "firmware_app/configured_parts.h"
#include "hal/cameras/recording/recording.h"
#include "hal/error.h"
#include "hal/numbered_path.h"

namespace pleinair::app {
namespace {

bool namesRecording(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) || hal::looksNumbered(path);
}

}  // namespace

std::unique_ptr<hal::Camera> openCamera(const CameraSettings& settings, hal::Clock& clock) {
  if (isSynthetic(settings)) {
    hal::SyntheticOptions options = syntheticOptions(settings);
    options.pacing = hal::Pacing::kRealTime;
    return std::make_unique<hal::SyntheticCamera>(options, clock);
  }
  if (namesRecording(settings.source)) {
    return hal::openRecording(settings.source, clock,
                              {.pacing = hal::Pacing::kRealTime, .loop = true});
  }
  throw hal::StartupError(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                     .subject = settings.source.string(),
                                     .problem = "is neither a camera nor a file",
                                     .remedy = "choose synthetic, or the path of a recording"});
}

}  // namespace pleinair::app
