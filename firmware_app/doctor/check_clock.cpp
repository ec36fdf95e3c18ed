#include <algorithm>
#include <array>
#include <string_view>

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

}  // namespace pleinair::app::doctor
