#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {
namespace {

std::string nameOf(const hal::CameraDescription& camera) {
  const std::string& what = camera.identity.description;
  if (camera.node.empty()) return what;
  return what.empty() ? camera.node : fmt::format("{} ({})", camera.node, what);
}

bool isUsable(const hal::CameraDescription& camera) {
  if (!camera.problem && !camera.areModesKnown) return true;
  return !camera.problem && std::ranges::any_of(camera.modes, &hal::CameraMode::isSupported);
}

/// How bad a camera's problem is, and what fixes it.
Finding troubled(Finding finding, const hal::CameraDescription& camera) {
  const hal::Error& problem = *camera.problem;
  finding.text = fmt::format("{}: {}", nameOf(camera), problem.problem);
  finding.verdict = Verdict::kWarning;
  finding.remedy = problem.remedy;
  if (problem.kind == hal::ErrorKind::kPermissionDenied) {
    finding.verdict = Verdict::kWrong;
    finding.remedy = "sudo usermod -aG video $USER, then log in again";
  } else if (problem.kind == hal::ErrorKind::kBusy) {
    finding.remedy = fmt::format("end the program that uses it: fuser -v {}", camera.node);
  }
  return finding;
}

}  // namespace

Finding checkCameras(const Probes& probes) {
  Finding finding{.check = "cameras"};
  const auto [cameras, problems] = probes.cameras();
  if (!problems.empty()) {
    finding.verdict = Verdict::kWrong;
    finding.text = problems.front().problem;
    finding.remedy = problems.front().remedy;
    return finding;
  }
  std::vector<std::string> usable;
  for (const hal::CameraDescription& camera : cameras) {
    if (isUsable(camera)) usable.push_back(nameOf(camera));
  }
  // A camera that may not be opened is to be fixed even where another one works.
  const auto forbidden = std::ranges::find_if(cameras, [](const auto& camera) {
    return camera.problem && camera.problem->kind == hal::ErrorKind::kPermissionDenied;
  });
  if (forbidden != cameras.end()) return troubled(finding, *forbidden);
  const auto ill =
      std::ranges::find_if(cameras, [](const auto& camera) { return camera.problem.has_value(); });
  if (ill != cameras.end()) return troubled(finding, *ill);
  finding.text = fmt::format("{}", fmt::join(usable, ", "));
  if (!usable.empty()) return finding;
  finding.verdict = Verdict::kWarning;
  finding.text = cameras.empty() ? "none: only recordings and the built-in one"
                                 : "none delivers frames that can be read";
  finding.remedy = cameras.empty() ? "plug one in; lsusb and sudo dmesg tell whether it is seen"
                                   : "`pleinair devices` lists what they offer";
  return finding;
}

Finding checkUsbCameras(const Probes& probes) {
  // /sys/module has loaded modules, and built-in ones that take parameters, as this one does.
  if (!probes.list("/sys/module/uvcvideo").empty()) {
    return {.check = "USB cameras", .text = "uvcvideo is loaded"};
  }
  return {.check = "USB cameras",
          .verdict = Verdict::kWarning,
          .text = "the kernel's uvcvideo is not loaded; plugging in a camera does that",
          .remedy = "sudo modprobe uvcvideo"};
}

Finding checkUdev(const Probes& probes) {
  for (const std::filesystem::path& entry : probes.list("/run/udev")) {
    if (entry.filename() == "control") return {.check = "udev", .text = "runs"};
  }
  return {.check = "udev",
          .verdict = Verdict::kWarning,
          .text = "does not run: cameras that come back are found late, and have no stable names",
          .remedy = "sudo systemctl start systemd-udevd (in a container: mount /run/udev)"};
}

Finding checkSocketBuffers(const Probes& probes) {
  constexpr std::uint64_t kEnough =
      4'000'000;  // one frame of 1280x1024 RGB8 and what comes meanwhile
  const std::string text = probes.read("/proc/sys/net/core/rmem_max").value_or("");
  std::uint64_t bytes = 0;
  std::from_chars(text.data(), text.data() + text.size(), bytes);
  Finding finding{.check = "socket buffers",
                  .text = fmt::format("net.core.rmem_max is {} kB", bytes / 1000)};
  if (bytes < kEnough) {
    finding.verdict = Verdict::kWarning;
    finding.text += ": GigE cameras lose frames";
    finding.remedy =
        "echo net.core.rmem_max=8388608 | sudo tee /etc/sysctl.d/60-pleinair.conf && "
        "sudo sysctl --system";
  }
  return finding;
}

}  // namespace pleinair::app::doctor
