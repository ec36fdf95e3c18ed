#include "hal/cameras/libcamera/settings.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "hal/cameras/missing_control.h"

namespace pleinair::hal::libcamera {
namespace {

constexpr std::array<std::string_view, kControls.size()> kControlNames{"exposure", "gain", "focus",
                                                                       "white_balance"};

std::string_view nameOf(Control control) {
  return kControlNames.at(static_cast<std::size_t>(control));
}

Error missing(Device& device, std::string_view what) {
  std::array<OfferedControl, kControls.size()> offered;
  std::ranges::transform(kControls, offered.begin(), [&](Control each) -> OfferedControl {
    return {.name = nameOf(each),
            .hasValue = device.range(each).has_value(),
            .hasAutomatic = device.hasAutomatic(each)};
  });
  return missingControl(what, offered);
}

template <class T, class ToUnits>
Result<void> set(Device& device, Control control, const std::optional<AutomaticOr<T>>& wanted,
                 ToUnits toUnits, StartSettings& settings) {
  if (!wanted) return {};
  auto& setting = settings.controls.at(static_cast<std::size_t>(control));
  if (std::holds_alternative<Automatic>(*wanted)) {
    if (!device.hasAutomatic(control)) {
      return tl::unexpected(missing(device, fmt::format("automatic {}", nameOf(control))));
    }
    setting = Automatic{};
    return {};
  }
  const std::optional<ControlRange> range = device.range(control);
  if (!range) return tl::unexpected(missing(device, nameOf(control)));
  const double value = toUnits(std::get<T>(*wanted), *range);
  setting = std::clamp(std::isnan(value) ? range->min : value, range->min,
                       std::max(range->min, range->max));
  return {};
}

}  // namespace

Result<StartSettings> settingsFor(Device& device, const StreamRequest& request) {
  StartSettings settings;
  const CameraControls& controls = request.controls;
  const auto microseconds = [](Duration time, const ControlRange&) {
    return std::chrono::duration<double, std::micro>(time).count();
  };
  const auto share = [](double part, const ControlRange& range) {
    return range.min + part * (range.max - range.min);
  };
  const auto same = [](double value, const ControlRange&) { return value; };
  Result<void> done = set(device, Control::kExposure, controls.exposure, microseconds, settings);
  if (done) done = set(device, Control::kGain, controls.gain, share, settings);
  if (done) done = set(device, Control::kFocus, controls.focus, share, settings);
  if (done) done = set(device, Control::kWhiteBalance, controls.whiteBalance, same, settings);
  if (!done) return tl::unexpected(done.error());
  if (const auto periods = device.periods(); periods && request.framePeriod) {
    settings.framePeriod =
        std::clamp(*request.framePeriod, (*periods)[0], std::max((*periods)[0], (*periods)[1]));
  }
  return settings;
}

}  // namespace pleinair::hal::libcamera
