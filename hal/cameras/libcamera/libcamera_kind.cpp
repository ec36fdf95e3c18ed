#include "hal/cameras/libcamera/libcamera_kind.h"

#include <array>

#include "config/parameter_table.h"

namespace pleinair::hal::libcamera {
namespace {

struct LibcameraSettings {
  Orientation orientation = Orientation::kUpright;
  int buffers = 6;
};

const config::ParameterTable<LibcameraSettings>& libcameraTable() {
  using S = LibcameraSettings;
  constexpr auto kRestart = config::TakesEffect::kRestart;
  static constexpr std::array<config::Choice<Orientation>, 4> kOrientations{
      {{"upright", Orientation::kUpright},
       {"rotated_180", Orientation::kRotated180},
       {"mirrored", Orientation::kMirrored},
       {"flipped", Orientation::kFlipped}}};
  static const config::ParameterTable<S> kTable{
      config::choiceParameter("orientation", &S::orientation, kOrientations,
                              "How the sensor turns the image, from the way it is mounted.",
                              kRestart),
      config::integerParameter("buffers", &S::buffers, {.min = 4, .max = 16},
                               "Frames that memory is asked for.", kRestart)};
  return kTable;
}

CameraDescription descriptionOf(const FoundCamera& camera) {
  return {.identity = {.backend = "libcamera", .id = camera.id, .description = camera.model},
          .path = camera.id,
          .areModesKnown = false};
}

}  // namespace

Result<std::vector<CameraDescription>> LibcameraBackend::list() {
  const Result<std::vector<FoundCamera>> found = library_.list();
  if (!found) return tl::unexpected(found.error());
  std::vector<CameraDescription> cameras;
  for (const FoundCamera& camera : *found) {
    if (!camera.isUsb) cameras.push_back(descriptionOf(camera));
  }
  return cameras;
}

std::unique_ptr<Camera> LibcameraBackend::make(const std::string& id, Clock& clock) {
  return std::make_unique<LibcameraCamera>(id, options_, library_, clock);
}

const CameraKind& cameraKind() {
  static const CameraKind kKind{
      .name = "libcamera",
      .help = "sensors whose image processor libcamera drives",
      .naming = CameraNaming::kDevices,
      .defaults = libcameraTable().defaults(),
      .open = [](const config::ParameterValues& own,
                 const CameraBackendOptions&) -> std::unique_ptr<CameraBackend> {
        const LibcameraSettings settings = libcameraTable().typed(own);
        return std::make_unique<LibcameraBackend>(
            LibcameraOptions{.orientation = settings.orientation, .buffers = settings.buffers});
      }};
  return kKind;
}

}  // namespace pleinair::hal::libcamera
