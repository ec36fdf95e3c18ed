#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkUdev(const Probes& probes) {
  for (const std::filesystem::path& entry : probes.list("/run/udev")) {
    if (entry.filename() == "control") return {.check = "udev", .text = "runs"};
  }
  return {.check = "udev",
          .verdict = Verdict::kWarning,
          .text = "does not run: cameras that come back are found late, and have no stable names",
          .remedy = "sudo systemctl start systemd-udevd (in a container: mount /run/udev)"};
}

}  // namespace pleinair::app::doctor
