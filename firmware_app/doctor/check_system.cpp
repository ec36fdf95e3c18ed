#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkClock(const Probes& probes) {
  constexpr std::string_view kFolder = "/sys/devices/system/clocksource/clocksource0/";
  // Read by a slow bus, or once a tick.
  constexpr std::array<std::string_view, 4> kPoor{"acpi_pm", "hpet", "jiffies", "refined-jiffies"};
  const std::string path(kFolder);
  const std::string name = probes.read(path + "current_clocksource").value_or("");
  if (name.empty()) {
    return {.check = "clock", .verdict = Verdict::kOk, .text = "the kernel does not say which"};
  }
  if (std::ranges::find(kPoor, name) == kPoor.end()) return {.check = "clock", .text = name};
  return {
      .check = "clock",
      .verdict = Verdict::kWarning,
      .text = fmt::format("{}: coarse or slow to read, latencies are less exact", name),
      .remedy = fmt::format("sudo dmesg | grep -i -e tsc -e clocksource says why; to be had: {}",
                            probes.read(path + "available_clocksource").value_or("unknown"))};
}

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

namespace {

/// "MemAvailable:    1234 kB", in bytes.
std::optional<std::uint64_t> valueOf(std::string_view text, std::string_view name) {
  const std::size_t found = text.find(name);
  if (found == std::string_view::npos) return std::nullopt;
  text.remove_prefix(found + name.size());
  text.remove_prefix(std::min(text.find_first_of("0123456789"), text.size()));
  std::uint64_t kilobytes = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), kilobytes);
  if (status != std::errc()) return std::nullopt;
  return kilobytes * 1024;
}

}  // namespace

Finding checkMemory(const Probes& probes) {
  constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;
  constexpr std::uint64_t kScarce = 512 * kMiB;
  constexpr std::uint64_t kTooLittle = 200 * kMiB;
  const std::string text = probes.read("/proc/meminfo").value_or("");
  const std::optional<std::uint64_t> bytes = valueOf(text, "MemAvailable:");
  if (!bytes) {
    return {.check = "memory", .verdict = Verdict::kOk, .text = "the kernel does not say"};
  }
  Finding finding{.check = "memory", .text = fmt::format("{} MiB available", *bytes / kMiB)};
  if (*bytes < kScarce) {
    finding.verdict = *bytes < kTooLittle ? Verdict::kWrong : Verdict::kWarning;
    finding.remedy = "end other programs: ps aux --sort=-rss | head; or paint smaller";
  }
  return finding;
}

}  // namespace pleinair::app::doctor
