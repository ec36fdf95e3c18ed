#include <system_error>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkDisk(const Probes& probes) {
  constexpr std::uint64_t kMB = 1'000'000;
  constexpr std::uint64_t kFull = 100 * kMB;  // some dozens of pictures
  constexpr std::uint64_t kScarce = 1000 * kMB;
  const std::string folder = probes.snapshots.string();
  Finding finding{.check = "disk"};
  if (const int status = probes.access(probes.snapshots); status != 0) {
    finding.verdict = Verdict::kWrong;
    finding.text = fmt::format("{}: snapshots cannot be saved: {}", folder,
                               std::generic_category().message(status));
    finding.remedy =
        fmt::format("sudo install -d -o $USER '{}', or give another --snapshots", folder);
    return finding;
  }
  const std::optional<std::uint64_t> bytes = probes.freeBytes(probes.snapshots);
  if (!bytes) {
    finding.verdict = Verdict::kWarning;
    finding.text = fmt::format("{}: how much is free is not known", folder);
    finding.remedy = fmt::format("df -h '{}'", folder);
    return finding;
  }
  finding.text = fmt::format("{}: {} MB free", folder, *bytes / kMB);
  if (*bytes < kScarce) {
    finding.verdict = *bytes < kFull ? Verdict::kWrong : Verdict::kWarning;
    finding.remedy = fmt::format("make room: sudo du -xh '{}' | sort -h | tail", folder);
  }
  return finding;
}

}  // namespace pleinair::app::doctor
