#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {
namespace {

/// Whether modprobe would find it for the kernel that runs.
bool isInstalled(const Probes& probes) {
  const std::filesystem::path modules =
      std::filesystem::path("/lib/modules") /
      probes.read("/proc/sys/kernel/osrelease").value_or("unknown");
  for (const char* folder : {"updates/dkms", "extra", "updates"}) {
    for (const std::filesystem::path& file : probes.list(modules / folder)) {
      if (file.filename().string().starts_with("v4l2loopback.ko")) return true;
    }
  }
  return false;
}

Finding notLoaded(const Probes& probes) {
  Finding finding{.check = "loopback", .verdict = Verdict::kWarning};
  if (isInstalled(probes)) {
    finding.text = "v4l2loopback is not loaded: no output as a camera of this machine";
    finding.remedy = hal::kLoadLoopback;
  } else {
    finding.text = "v4l2loopback is not installed: no output as a camera of this machine";
    finding.remedy = fmt::format(
        "sudo apt install v4l2loopback-dkms linux-headers-$(uname -r) && {}", hal::kLoadLoopback);
  }
  return finding;
}

}  // namespace

Finding checkLoopback(const Probes& probes) {
  if (probes.list("/sys/module/v4l2loopback").empty()) return notLoaded(probes);
  const std::string again = fmt::format("sudo modprobe -r v4l2loopback && {}", hal::kLoadLoopback);
  Finding finding{.check = "loopback", .verdict = Verdict::kWarning, .remedy = again};
  const std::vector<hal::LoopbackDevice> devices = probes.loopbacks();
  const auto forbidden = std::ranges::find_if(devices, [](const auto& device) {
    return device.problem && device.problem->kind == hal::ErrorKind::kPermissionDenied;
  });
  if (forbidden != devices.end()) {
    finding.verdict = Verdict::kWrong;
    finding.text = fmt::format("{}: {}", forbidden->node, forbidden->problem->problem);
    finding.remedy = "sudo usermod -aG video $USER, then log in again";
    return finding;
  }
  const auto device = std::ranges::find(devices, true, &hal::LoopbackDevice::isLoopback);
  if (device == devices.end()) {
    finding.text = "v4l2loopback is loaded and has no device";
    return finding;
  }
  finding.text = fmt::format("{} ({})", device->node, device->card);
  // One letter a device, the first for the first: "Y,N,N,N,N,N,N,N".
  const auto exclusive = probes.read("/sys/module/v4l2loopback/parameters/exclusive_caps");
  if (exclusive && !exclusive->starts_with('Y')) {
    finding.text += ": without exclusive_caps=1, which browsers need to see it";
    return finding;
  }
  finding.verdict = Verdict::kOk;
  finding.remedy.clear();
  if (!device->isWritable) finding.text += ", another program writes to it now";
  return finding;
}

}  // namespace pleinair::app::doctor
