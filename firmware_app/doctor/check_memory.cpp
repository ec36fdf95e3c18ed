#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {
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
  constexpr std::uint64_t kMiB = 1024 * 1024;
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
