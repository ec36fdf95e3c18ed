#include "hal/cameras/aravis/aravis_kind.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "config/parameter_table.h"
#include "hal/cameras/aravis/aravis_camera.h"
#include "hal/cameras/aravis/pixel_layout.h"
#include "hal/printable.h"

namespace pleinair::hal::aravis {
namespace {

struct AravisSettings {
  std::string pixelFormat = "auto";
  int offsetX = -1;
  int offsetY = -1;
  int binning = 1;
  std::string trigger = "free";
  int packetSize = 0;
  bool resend = true;
  double frameRetention = 100;
  int socketBuffer = 4096;
  bool packetSocket = true;
  int buffers = 8;
  bool chunkTimestamps = true;
  bool gige = true;
  bool usb3 = true;
};

/// Names are spelt as the convention does, with capitals.
bool isFormatName(std::string_view text) {
  return text == "auto" ||
         std::ranges::find(pixelLayouts(), text, &PixelLayout::name) != pixelLayouts().end();
}

std::string formatNames() {
  std::string names = "auto";
  for (const PixelLayout& layout : pixelLayouts()) names += ", " + std::string(layout.name);
  return names;
}

const config::ParameterTable<AravisSettings>& aravisTable() {
  using S = AravisSettings;
  using config::integerParameter;
  using config::switchParameter;
  constexpr auto kRestart = config::TakesEffect::kRestart;
  static const config::ParameterTable<S> kTable{
      config::textParameter("pixel_format", &S::pixelFormat, "one of " + formatNames(),
                            "What the camera sends; \"auto\": colour, in few bits a pixel.",
                            kRestart, isFormatName),
      integerParameter("offset_x", &S::offsetX, {.min = -1, .max = 65535, .unit = "px"},
                       "Where the region begins on the sensor; -1: in the middle.", kRestart),
      integerParameter("offset_y", &S::offsetY, {.min = -1, .max = 65535, .unit = "px"},
                       "The same, from the top.", kRestart),
      integerParameter("binning", &S::binning, {.min = 1, .max = 16},
                       "So many sensor pixels in each direction become one.", kRestart),
      config::textParameter("trigger", &S::trigger,
                            "free, software, or a line of the camera such as Line1",
                            "What asks for a frame: the camera's own rate, the program at "
                            "camera.rate, or a signal on a line.",
                            kRestart, [](std::string_view text) { return !text.empty(); }),
      integerParameter(
          "packet_size", &S::packetSize, {.min = 0, .max = 65535, .unit = "bytes"},
          "Of GigE packets with their headers; 0: the largest that passes the network.", kRestart),
      switchParameter("resend", &S::resend, "Whether lost GigE packets are asked for again.",
                      kRestart),
      config::numberParameter(
          "frame_retention", &S::frameRetention, {.min = 1, .max = 10000, .unit = "ms"},
          "How long an incomplete frame is waited for after its last packet.", kRestart),
      integerParameter("socket_buffer", &S::socketBuffer, {.min = 0, .max = 1048576, .unit = "KiB"},
                       "Receive buffer of a GigE camera's socket; 0: one frame.", kRestart),
      switchParameter("packet_socket", &S::packetSocket,
                      "Whether packets are read below UDP where the program may (CAP_NET_RAW).",
                      kRestart),
      integerParameter("buffers", &S::buffers, {.min = 4, .max = 64},
                       "Frames that memory is kept for.", kRestart),
      switchParameter("chunk_timestamps", &S::chunkTimestamps,
                      "Whether frames bring the device's time in chunk data, where it can.",
                      kRestart),
      switchParameter("gige", &S::gige, "Whether cameras are looked for on the network, for 1 s.",
                      kRestart),
      switchParameter("usb3", &S::usb3, "Whether cameras are looked for on USB.", kRestart)};
  return kTable;
}

AravisOptions optionsOf(const AravisSettings& settings) {
  return {.pixelFormat = settings.pixelFormat,
          .offsetX = settings.offsetX,
          .offsetY = settings.offsetY,
          .binning = settings.binning,
          .trigger = settings.trigger,
          .packetBytes = settings.packetSize,
          .resends = settings.resend,
          .frameRetention = fromMilliseconds(settings.frameRetention),
          .socketBufferBytes = static_cast<std::size_t>(settings.socketBuffer) * 1024,
          .packetSocket = settings.packetSocket,
          .buffers = settings.buffers,
          .chunkTimestamps = settings.chunkTimestamps};
}

CameraDescription descriptionOf(const FoundDevice& device, bool isOnlyOne) {
  const std::string name =
      device.vendor.empty() ? device.model : device.vendor + " " + device.model;
  return {.identity = {.backend = "aravis",
                       .id = isOnlyOne || device.physicalId.empty() ? device.id : device.physicalId,
                       .description = printable(name)},
          .serial = printable(device.serial),
          .path = device.physicalId,
          .node = device.address,
          .areModesKnown = false};
}

}  // namespace

Result<std::vector<CameraDescription>> AravisBackend::list() {
  const Result<std::vector<FoundDevice>> found =
      library_.discover(discovery_.gige, discovery_.usb3);
  if (!found) return tl::unexpected(found.error());
  std::vector<CameraDescription> cameras;
  for (const FoundDevice& device : *found) {
    const auto namesakes = std::ranges::count(*found, device.id, &FoundDevice::id);
    cameras.push_back(descriptionOf(device, namesakes == 1));
  }
  std::ranges::sort(cameras, {}, [](const CameraDescription& each) { return each.identity.id; });
  return cameras;
}

std::unique_ptr<Camera> AravisBackend::make(const std::string& id, Clock& clock) {
  return std::make_unique<AravisCamera>(id, options_, library_, clock);
}

Result<OfferedModes> AravisBackend::offeredModes(const std::string& id,
                                                 const StreamRequest& request) {
  const auto named = [&](Error error) {
    if (error.subject.empty()) error.subject = "aravis:" + id;
    return tl::unexpected(std::move(error));
  };
  const Result<std::unique_ptr<Device>> device = library_.open(id);
  if (!device) return named(device.error());
  const Result<std::vector<std::uint32_t>> offered = (*device)->pixelFormats();
  if (!offered) return named(offered.error());
  const Result<RegionBounds> bounds = readBounds(**device);
  if (!bounds) return named(bounds.error());
  const Result<const PixelLayout*> layout =
      chooseLayout(*offered, options_.pixelFormat, request.pixelFormat);
  if (!layout) return named(layout.error());
  OfferedModes modes;
  for (const std::uint32_t pfnc : *offered) {
    modes.modes.push_back({.layout = layoutName(pfnc),
                           .size = {bounds->width.max, bounds->height.max},
                           .periods = {},
                           .isSupported = findLayout(pfnc) != nullptr});
  }
  const FrameSize size = regionSizeFor(*bounds, **layout, request.size);
  modes.chosen.mode = {.layout = std::string((*layout)->name), .size = size, .periods = {}};
  modes.chosen.reason = options_.pixelFormat != "auto" ? "camera.aravis.pixel_format is set"
                        : request.pixelFormat && (*layout)->pixelFormat == *request.pixelFormat
                            ? "the pixel format asked for"
                            : "colour comes before grey, and few bits a pixel before many";
  if (size != FrameSize{bounds->width.max, bounds->height.max}) {
    modes.chosen.reason +=
        fmt::format("; a region of {}x{} px", bounds->width.max, bounds->height.max);
  }
  return modes;
}

const CameraKind& cameraKind() {
  static const CameraKind kKind{
      .name = "aravis",
      .help = "GigE Vision and USB3 Vision cameras",
      .naming = CameraNaming::kDevices,
      .defaults = aravisTable().defaults(),
      .open = [](const config::ParameterValues& own,
                 const CameraBackendOptions&) -> std::unique_ptr<CameraBackend> {
        const AravisSettings settings = aravisTable().typed(own);
        return std::make_unique<AravisBackend>(
            optionsOf(settings), AravisDiscovery{.gige = settings.gige, .usb3 = settings.usb3});
      }};
  return kKind;
}

}  // namespace pleinair::hal::aravis
