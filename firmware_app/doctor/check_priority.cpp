#include <charconv>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {
namespace {

/// Whether the limit does not count: linux/capability.h's CAP_SYS_NICE among those in force.
bool isExempt(const Probes& probes) {
  constexpr int kSysNice = 23;
  constexpr std::string_view kName = "CapEff:\t";
  const std::string text = probes.read("/proc/self/status").value_or("");
  const std::size_t found = text.find(kName);
  if (found == std::string::npos) return false;
  std::uint64_t capabilities = 0;
  std::from_chars(text.data() + found + kName.size(), text.data() + text.size(), capabilities, 16);
  return (capabilities >> kSysNice & 1) != 0;
}

}  // namespace

Finding checkPriority(const Probes& probes) {
  const std::uint64_t most = probes.limit(RLIMIT_RTPRIO);
  if (most > 0 || isExempt(probes)) {
    constexpr std::uint64_t kHighest = 99;
    const bool isLimited = most > 0 && most < kHighest && !isExempt(probes);
    return {.check = "priority",
            .text = fmt::format("real-time up to {}", isLimited ? most : kHighest)};
  }
  return {.check = "priority",
          .verdict = Verdict::kWarning,
          .text = "no real-time priority: other programs' load shows as late frames",
          .remedy =
              "echo '@video - rtprio 50' | sudo tee /etc/security/limits.d/60-pleinair.conf, "
              "then log in again (systemd: LimitRTPRIO=50)"};
}

}  // namespace pleinair::app::doctor
