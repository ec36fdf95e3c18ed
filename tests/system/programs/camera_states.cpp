// The camera of the program, found and supervised as it is there, without a painter: what becomes
// of it, each change with the time (of the clock that date(1) tells), and how many frames there
// were since the one before.
//
// usage: camera_states [SOURCE]      "auto" by default. Ends by a signal.
#include <array>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "hal/cameras/registry.h"
#include "hal/supervisor/camera_selector.h"
#include "hal/supervisor/camera_supervisor.h"
#include "hal/supervisor/hotplug_monitor.h"
#include "hal/supervisor/worker_camera.h"

namespace {

using namespace pleinair;

void tell(const std::string& what) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  fmt::print("{:.3f} {}\n", std::chrono::duration<double>(now).count(), what);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<hal::SelectableBackend> backends;
  for (const hal::CameraKind* kind : hal::cameraKinds()) {
    if (kind->naming != hal::CameraNaming::kDevices) continue;
    backends.push_back({.backend = kind->open(kind->defaults, {})});
  }
  hal::SteadyClock clock;
  hal::CameraSelector selector(std::move(backends), argc > 1 ? argv[1] : "auto", clock,
                               hal::onDriverThreads());
  hal::CameraSupervisor supervisor(selector, clock, {}, {.size = hal::FrameSize{320, 180}});
  auto events = hal::udevEvents();
  if (!events) tell(events.error().message());
  std::unique_ptr<hal::HotplugMonitor> monitor;
  if (events) {
    monitor = std::make_unique<hal::HotplugMonitor>(
        *std::move(events), [&](const hal::DeviceEvent&) { supervisor.devicesChanged(); });
  }
  int frames = 0;
  for (;;) {
    const hal::SupervisedNext next = supervisor.next(clock.now() + std::chrono::seconds(1));
    if (std::holds_alternative<hal::SupervisedFrame>(next)) ++frames;
    if (const auto* changed = std::get_if<hal::CameraStateChanged>(&next)) {
      tell(fmt::format("{} ({} frames): {}", toString(changed->state), std::exchange(frames, 0),
                       changed->reason));
    }
  }
}
