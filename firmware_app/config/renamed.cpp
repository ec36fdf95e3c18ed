#include "firmware_app/config/renamed.h"

#include <algorithm>
#include <array>

namespace pleinair::app {
namespace {

struct RenamedValue {
  std::string_view key;
  std::string_view old;
  std::string_view now;
};

constexpr std::array<config::RenamedKey, 11> kKeys{{
    {"camera.seed", "camera.synthetic.seed"},
    {"camera.noise", "camera.synthetic.noise"},
    {"camera.exposure_drift", "camera.synthetic.exposure_drift"},
    {"camera.white_balance_drift", "camera.synthetic.white_balance_drift"},
    {"camera.readout", "camera.synthetic.readout"},
    {"output.target", "output.targets"},
    {"output.second_target", "output.targets"},
    {"output.third_target", "output.targets"},
    {"output.loopback_format", "output.loopback.format"},
    {"output.stills", "output.snapshots"},
    {"style.watercolor.steady_time", "style.watercolor.filter_time"},
}};

constexpr std::array<config::RenamedKey, 1> kOptions{{
    {"--stills", "--snapshots"},
}};

constexpr std::array<RenamedValue, 1> kValues{{
    {"painting.view", "steady", "filtered"},
}};

}  // namespace

std::span<const config::RenamedKey> renamedKeys() {
  return kKeys;
}

std::optional<std::string_view> renamedOption(std::string_view option) {
  const auto found = std::ranges::find(kOptions, option, &config::RenamedKey::old);
  return found == kOptions.end() ? std::nullopt : std::optional(found->now);
}

std::optional<std::string_view> renamedValue(std::string_view key, std::string_view value) {
  const auto found = std::ranges::find_if(
      kValues, [&](const RenamedValue& each) { return each.key == key && each.old == value; });
  return found == kValues.end() ? std::nullopt : std::optional(found->now);
}

}  // namespace pleinair::app
