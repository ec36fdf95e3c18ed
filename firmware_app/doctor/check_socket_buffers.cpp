#include <charconv>
#include <cstdint>

#include <fmt/format.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {

Finding checkSocketBuffers(const Probes& probes) {
  constexpr std::uint64_t kEnough =
      4'000'000;  // one frame of 1280x1024 RGB8 and what comes meanwhile
  const std::string text = probes.read("/proc/sys/net/core/rmem_max").value_or("");
  std::uint64_t bytes = 0;
  std::from_chars(text.data(), text.data() + text.size(), bytes);
  Finding finding{.check = "socket buffers",
                  .text = fmt::format("net.core.rmem_max is {} kB", bytes / 1000)};
  if (bytes < kEnough) {
    finding.verdict = Verdict::kWarning;
    finding.text += ": GigE cameras lose frames";
    finding.remedy =
        "echo net.core.rmem_max=8388608 | sudo tee /etc/sysctl.d/60-pleinair.conf && "
        "sudo sysctl --system";
  }
  return finding;
}

}  // namespace pleinair::app::doctor
