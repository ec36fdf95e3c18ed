#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "firmware_app/doctor/checks.h"

namespace pleinair::app::doctor {
namespace {

/// The network device that leads to an IPv4 address, by /proc/net/route; empty if none does.
std::string deviceTo(const Probes& probes, const std::string& address) {
  in_addr parsed{};
  if (inet_pton(AF_INET, address.c_str(), &parsed) != 1) return {};
  if ((ntohl(parsed.s_addr) >> 24) == 127) return "lo";  // in a table of its own
  std::istringstream routes(probes.read("/proc/net/route").value_or(""));
  std::string line, best;
  int bestLength = -1;
  while (std::getline(routes, line)) {
    // Iface Destination Gateway Flags RefCnt Use Metric Mask …; addresses in network order, as hex.
    std::istringstream fields(line);
    std::string name, gateway, flags, uses, references, metric;
    std::uint32_t destination = 0, mask = 0;
    if (!(fields >> name >> std::hex >> destination >> gateway >> flags >> uses >> references >>
          metric >> mask)) {
      continue;  // the heading
    }
    const int length = std::popcount(mask);
    if ((parsed.s_addr & mask) == destination && length > bestLength) {
      best = name;
      bestLength = length;
    }
  }
  return best;
}

std::optional<int> numberIn(const Probes& probes, const std::string& file) {
  const std::string text = probes.read(file).value_or("");
  int number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  return status == std::errc() && number > 0 ? std::optional(number) : std::nullopt;
}

/// What the link to one camera has, and what is wrong with it.
void examineLink(const Probes& probes, const hal::CameraDescription& camera, Finding& finding) {
  constexpr int kPlainMtu = 1500;
  constexpr double kJumboMbits = 400;  // above, 1500-byte packets keep a small core busy
  constexpr double kOverhead = 1.06;   // headers of Ethernet, IP, UDP and GVSP
  const std::string device = deviceTo(probes, camera.node);
  const auto say = [&](const std::string& text) {
    finding.text += (finding.text.empty() ? "" : "; ") + text;
  };
  const auto warn = [&](std::string remedy) {
    if (finding.verdict == Verdict::kOk) finding.remedy = std::move(remedy);
    finding.verdict = Verdict::kWarning;
  };
  if (device.empty()) {
    say(fmt::format("{}: no network leads to {}", camera.identity.id, camera.node));
    return warn("ip route; give the computer an address in the camera's network");
  }
  const std::string folder = "/sys/class/net/" + device;
  const std::optional<int> mtu = numberIn(probes, folder + "/mtu");
  const std::optional<int> mbits = numberIn(probes, folder + "/speed");  // none of "lo"
  const double asked =
      probes.askedPixelsPerSecond ? probes.askedPixelsPerSecond() * 8 * kOverhead / 1e6 : 0;
  say(fmt::format("{} at {}: MTU {}{}", camera.identity.id, device,
                  mtu ? std::to_string(*mtu) : "unknown",
                  mbits ? fmt::format(", {} Mbit/s", *mbits) : ""));
  if (mbits && asked > *mbits) {
    finding.text += fmt::format(", but camera.size and rate need {:.0f} at 8 bits a pixel", asked);
    return warn("set a smaller camera.size or camera.rate, or use a faster port and cable");
  }
  if (mtu && *mtu < kPlainMtu) {
    finding.text += ", too small for most cameras";
    return warn(fmt::format("sudo ip link set {} mtu {}", device, kPlainMtu));
  }
  if (mtu && *mtu == kPlainMtu && asked > kJumboMbits) {
    finding.text += fmt::format(", and {:.0f} Mbit/s are asked for", asked);
    warn(fmt::format("where camera and switches can: sudo ip link set {} mtu 9000", device));
  }
}

}  // namespace

Finding checkCameraLinks(const Probes& probes) {
  Finding finding{.check = "camera links"};
  for (const hal::CameraDescription& camera : probes.cameras().cameras) {
    in_addr ignored{};
    if (inet_pton(AF_INET, camera.node.c_str(), &ignored) != 1) continue;
    examineLink(probes, camera, finding);
  }
  if (finding.text.empty()) finding.text = "no camera is on the network";
  return finding;
}

}  // namespace pleinair::app::doctor
