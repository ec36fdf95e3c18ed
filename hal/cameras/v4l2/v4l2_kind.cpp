#include "hal/cameras/v4l2/v4l2_kind.h"

#include <array>
#include <optional>

#include "config/parameter_table.h"
#include "hal/cameras/v4l2/find_device.h"

namespace pleinair::hal::v4l2 {
namespace {

const config::ParameterTable<FrameMemoryOptions>& v4l2Table() {
  using S = FrameMemoryOptions;
  static constexpr std::array<config::Choice<std::optional<AllocatorKind>>, 4> kSources{
      {{"device", std::nullopt},
       {"heap", AllocatorKind::kHeap},
       {"udmabuf", AllocatorKind::kUdmabuf},
       {"vgem", AllocatorKind::kVgem}}};
  static const config::ParameterTable<S> kTable{config::choiceParameter(
      "memory", &S::allocator, kSources,
      "Where frames lie: in memory of the device, or of an allocator that it shares with the GPU.",
      config::TakesEffect::kRestart)};
  return kTable;
}

}  // namespace

Result<std::vector<CameraDescription>> V4l2Backend::list() {
  return listDevices(system_);
}

std::unique_ptr<Camera> V4l2Backend::make(const std::string& id, Clock& clock) {
  return std::make_unique<V4l2Camera>(id, system_, clock, memory_);
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
