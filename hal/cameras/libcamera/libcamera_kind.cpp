#include "hal/cameras/libcamera/libcamera_kind.h"

#include <array>
#include <utility>

#include <fmt/format.h>

#include "config/parameter_table.h"
#include "hal/cameras/libcamera/frame_layout.h"
#include "hal/cameras/libcamera/host_process.h"
#include "hal/cameras/libcamera/settings.h"
#include "hal/printable.h"

namespace pleinair::hal::libcamera {
namespace {

struct LibcameraSettings {
  Orientation orientation = Orientation::kUpright;
  int buffers = 6;
  bool secondStream = true;
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
                               "Frames that memory is asked for.", kRestart),
      config::switchParameter("second_stream", &S::secondStream,
                              "Whether a small image of each frame is asked for, for trackers.",
                              kRestart)};
  return kTable;
}

std::vector<CameraMode> modesOf(const std::vector<OfferedFormat>& offered) {
  std::vector<CameraMode> modes;
  for (const OfferedFormat& format : offered) {
    for (const FrameSize& size : format.sizes) {
      modes.push_back({.layout = fourccName(format.fourcc),
                       .size = size,
                       .periods = {},
                       .isSupported = findLayout(format.fourcc) != nullptr});
    }
  }
  return modes;
}

std::string reasonText(const StreamWish& wish, const StreamAnswer& answer,
                       const StreamRequest& request) {
  const FrameLayout* const layout = findLayout(answer.fourcc);
  std::string text = layout != nullptr && layout->swappedBytes > 0
                         ? "every format that is read has to be converted on the processor"
                         : "the cheapest to paint of the formats that are read as they are";
  if (request.pixelFormat && layout != nullptr && layout->pixelFormat == *request.pixelFormat) {
    text = "the pixel format asked for";
  }
  if (answer.size == wish.size) return text;
  return fmt::format("{}; libcamera gives {}x{} px for {}x{}", text, answer.size.width,
                     answer.size.height, wish.size.width, wish.size.height);
}

CameraDescription descriptionOf(const FoundCamera& camera) {
  return {
      .identity = {.backend = "libcamera", .id = camera.id, .description = printable(camera.model)},
      .path = camera.id,
      .areModesKnown = false,
      .kept = camera.kept};
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

Result<OfferedModes> LibcameraBackend::offeredModes(const std::string& id,
                                                    const StreamRequest& request) {
  const auto named = [&](Error error) {
    if (error.subject.empty()) error.subject = "libcamera:" + id;
    return tl::unexpected(std::move(error));
  };
  const Result<std::unique_ptr<Device>> device = library_.open(id);
  if (!device) return named(device.error());
  const std::vector<OfferedFormat> offered = (*device)->formats();
  Result<StreamWish> wish = chooseFormat(offered, request.size, request.pixelFormat);
  if (!wish) return named(wish.error());
  wish->buffers = options_.buffers;
  wish->orientation = options_.orientation;
  const Result<StreamAnswer> answer = (*device)->configure(*wish);
  if (!answer) return named(answer.error());
  OfferedModes modes{
      .modes = modesOf(offered),
      .chosen = {
          .mode = {.layout = fourccName(answer->fourcc), .size = answer->size, .periods = {}},
          .reason = reasonText(*wish, *answer, request)}};
  // Without the controls, which the camera may lack.
  const Result<StartSettings> settings =
      settingsFor(**device, {.framePeriod = request.framePeriod});
  if (settings && settings->framePeriod) modes.chosen.mode.periods = {*settings->framePeriod};
  return modes;
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
            LibcameraOptions{.orientation = settings.orientation,
                             .buffers = settings.buffers,
                             .makesLuma = settings.secondStream},
            hostedLibrary());
      }};
  return kKind;
}

}  // namespace pleinair::hal::libcamera
