#include "firmware_app/live/open_camera.h"

#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include "hal/cameras/recording/recording.h"
#include "hal/cameras/synthetic/synthetic_camera.h"
#include "hal/error.h"
#include "hal/numbered_path.h"

namespace pleinair::app {
namespace {

bool namesRecording(const std::filesystem::path& path) {
  std::error_code ignored;
  return std::filesystem::exists(path, ignored) || hal::looksNumbered(path);
}

}  // namespace

std::unique_ptr<hal::Camera> openCamera(const std::string& name,
                                        const std::optional<hal::FrameSize>& size,
                                        hal::Clock& clock) {
  if (name == "synthetic") {
    hal::SyntheticOptions options{.pacing = hal::Pacing::kRealTime};
    if (size) options.size = *size;
    return std::make_unique<hal::SyntheticCamera>(options, clock);
  }
  if (namesRecording(name)) {
    return hal::openRecording(name, clock, {.pacing = hal::Pacing::kRealTime, .loop = true});
  }
  throw hal::StartupError(
      hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                 .subject = "--camera",
                 .problem = fmt::format("unknown camera \"{}\", and no file of that name", name),
                 .remedy = "allowed: synthetic, or the path of a recording"});
}

}  // namespace pleinair::app
