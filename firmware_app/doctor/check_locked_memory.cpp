#include <fmt/format.h>
#include <sys/resource.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkLockedMemory(const Probes& probes) {
  constexpr std::uint64_t kMiB = 1024 * 1024;
  constexpr std::uint64_t kEnough = 8 * kMiB;  // the kernel's default, which drivers count on
  const std::uint64_t most = probes.limit(RLIMIT_MEMLOCK);
  Finding finding{.check = "locked memory",
                  .text = most == RLIM_INFINITY ? "unlimited" : fmt::format("{} MiB", most / kMiB)};
  if (most < kEnough) {
    finding.verdict = Verdict::kWarning;
    finding.text = fmt::format("{} KiB: drivers may fail to pin buffers", most / 1024);
    finding.remedy =
        "echo '@video - memlock 65536' | sudo tee -a /etc/security/limits.d/60-pleinair.conf, "
        "then log in again (systemd: LimitMEMLOCK=64M)";
  }
  return finding;
}

}  // namespace pleinair::app::doctor
