#include <fmt/format.h>
#include <sys/resource.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkPriority(const Probes& probes) {
  const std::uint64_t most = probes.limit(RLIMIT_RTPRIO);
  if (most > 0) {
    return {.check = "priority",
            .text = fmt::format("real-time up to {}", most == RLIM_INFINITY ? 99 : most)};
  }
  return {.check = "priority",
          .verdict = Verdict::kWarning,
          .text = "no real-time priority: other programs' load shows as late frames",
          .remedy =
              "echo '@video - rtprio 50' | sudo tee /etc/security/limits.d/60-pleinair.conf, "
              "then log in again (systemd: LimitRTPRIO=50)"};
}

}  // namespace pleinair::app::doctor
