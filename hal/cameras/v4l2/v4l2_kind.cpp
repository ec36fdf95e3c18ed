#include "hal/cameras/v4l2/v4l2_kind.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <optional>
#include <utility>

#include "config/parameter_table.h"
#include "hal/cameras/v4l2/find_device.h"
#include "hal/cameras/v4l2/format.h"
#include "hal/cameras/v4l2/modes.h"
#include "hal/v4l2/formats.h"

namespace pleinair::hal::v4l2 {
namespace {

const config::ParameterTable<V4l2Options>& v4l2Table() {
  using S = V4l2Options;
  static constexpr std::array<config::Choice<std::optional<AllocatorKind>>, 4> kSources{
      {{"device", std::nullopt},
       {"heap", AllocatorKind::kHeap},
       {"udmabuf", AllocatorKind::kUdmabuf},
       {"vgem", AllocatorKind::kVgem}}};
  static constexpr std::array<config::Choice<std::optional<PowerLine>>, 5> kPowerLines{
      {{"device", std::nullopt},
       {"off", PowerLine::kOff},
       {"50", PowerLine::k50Hz},
       {"60", PowerLine::k60Hz},
       {"auto", PowerLine::kAuto}}};
  static const config::ParameterTable<S> kTable{
      config::choiceParameter("memory", &S::allocator, kSources,
                              "Where frames lie: in memory of the device, or of an allocator that "
                              "it shares with the GPU.",
                              config::TakesEffect::kRestart),
      config::choiceParameter("power_line", &S::powerLine, kPowerLines,
                              "The mains' frequency in Hz, against flicker in the light of lamps.",
                              config::TakesEffect::kRestart)};
  return kTable;
}

}  // namespace

Result<std::vector<CameraDescription>> V4l2Backend::list() {
  return listDevices(system_);
}

std::unique_ptr<Camera> V4l2Backend::make(const std::string& id, Clock& clock) {
  return std::make_unique<V4l2Camera>(id, system_, clock, options_);
}

Result<OfferedModes> V4l2Backend::offeredModes(const std::string& id,
                                               const StreamRequest& request) {
  const Result<std::string> node = findNode(system_, id);
  if (!node) return tl::unexpected(node.error());
  const Result<Device> device = Device::open(system_.calls, *node);
  if (!device) return tl::unexpected(device.error());
  const Result<ModeChoice> choice = chooseMode(*device, request);
  if (!choice) return tl::unexpected(choice.error());
  CameraMode mode{.layout = fourccText(choice->layout->fourcc),
                  .size = choice->size.value_or(currentSize(*device).value_or(FrameSize{})),
                  .periods = {}};
  if (!choice->periods.empty()) {
    // Drivers take the listed period that is nearest.
    const Duration wanted = choice->period.value_or(choice->periods.front());
    mode.periods = {*std::ranges::min_element(
        choice->periods, {}, [&](Duration each) { return std::chrono::abs(each - wanted); })};
  }
  return OfferedModes{.modes = modesOf(*device),
                      .chosen = {.mode = std::move(mode), .reason = choice->reason}};
}

const CameraKind& cameraKind() {
  static const CameraKind kKind{
      .name = "v4l2",
      .help = "webcams, capture cards and sensor boards of Linux",
      .naming = CameraNaming::kDevices,
      .nodePrefix = "/dev/video",
      .defaults = v4l2Table().defaults(),
      .open = [](const config::ParameterValues& own,
                 const CameraBackendOptions&) -> std::unique_ptr<CameraBackend> {
        return std::make_unique<V4l2Backend>(kernelSystem(), v4l2Table().typed(own));
      }};
  return kKind;
}

}  // namespace pleinair::hal::v4l2
