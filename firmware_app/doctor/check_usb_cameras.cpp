#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

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

}  // namespace pleinair::app::doctor
