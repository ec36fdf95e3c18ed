#include <algorithm>
#include <charconv>
#include <cstdint>
#include <string>

#include <fmt/format.h>
#include <sys/resource.h>

#include "firmware_app/doctor/checks.h"
#include "pipeline/runtime/thread_role.h"

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
  constexpr std::uint64_t kHighest = 99;
  const std::uint64_t most =
      isExempt(probes) ? kHighest : std::min(kHighest, probes.limit(RLIMIT_RTPRIO));
  if (most >= runtime::kPromptPriority) {
    return {.check = "priority", .text = fmt::format("real-time up to {}", most)};
  }
  const std::string found =
      most == 0 ? "no real-time priority"
                : fmt::format("real-time up to {} of {}", most, runtime::kPromptPriority);
  return {.check = "priority",
          .verdict = Verdict::kWarning,
          .text = found + ": other programs' load shows as late frames",
          .remedy =
              "echo '@video - rtprio 50' | sudo tee /etc/security/limits.d/60-pleinair.conf, "
              "then log in again (systemd: LimitRTPRIO=50)"};
}

Finding checkLockedMemory(const Probes& probes) {
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
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
