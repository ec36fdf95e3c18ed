#include "hal/cameras/v4l2/controls.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <linux/videodev2.h>

namespace pleinair::hal::v4l2 {
namespace {

/// The unit of V4L2_CID_EXPOSURE_ABSOLUTE.
using ExposureTicks = std::chrono::duration<double, std::ratio<1, 10'000>>;

/// The device's description of one of its controls.
struct Control {
  std::uint32_t id = 0;
  std::int64_t min = 0, max = 0, step = 1;
};

std::optional<Control> findControl(const Device& device, std::uint32_t id) {
  v4l2_queryctrl query{};
  query.id = id;
  if (device.ask(VIDIOC_QUERYCTRL, query) < 0) return std::nullopt;
  if ((query.flags & (V4L2_CTRL_FLAG_DISABLED | V4L2_CTRL_FLAG_READ_ONLY)) != 0) {
    return std::nullopt;
  }
  return Control{
      .id = id, .min = query.minimum, .max = query.maximum, .step = std::max(query.step, 1)};
}

std::int64_t onStep(const Control& control, double wanted) {
  const double bounded =
      std::clamp(std::isnan(wanted) ? 0.0 : wanted, static_cast<double>(control.min),
                 static_cast<double>(control.max));
  const auto steps = std::llround((bounded - static_cast<double>(control.min)) /
                                  static_cast<double>(control.step));
  const std::int64_t value = control.min + steps * control.step;
  return value > control.max ? value - control.step : value;
}

Result<void> set(const Device& device, std::uint32_t id, std::int64_t value,
                 const std::string& name) {
  v4l2_control control{};
  control.id = id;
  control.value = static_cast<std::int32_t>(value);
  if (const int answer = device.ask(VIDIOC_S_CTRL, control); answer < 0) {
    return tl::unexpected(device.failure("cannot set its " + name, answer));
  }
  return {};
}

bool hasMenuItem(const Device& device, const Control& control, std::int64_t item) {
  if (item < control.min || item > control.max) return false;
  v4l2_querymenu query{};
  query.id = control.id;
  query.index = static_cast<std::uint32_t>(item);
  return device.ask(VIDIOC_QUERYMENU, query) >= 0;
}

/// The V4L2 controls behind a neutral control: the one that sets a value, and the one that switches
/// the device's automatic control on and off, with its values. A device may lack either.
struct Pair {
  std::string name;
  std::optional<Control> value;
  std::optional<Control> loop;
  std::optional<std::int64_t> loopOn;
  std::optional<std::int64_t> loopOff;
};

Pair switchPair(const Device& device, std::string name, std::optional<Control> value,
                std::uint32_t loopId) {
  return {.name = std::move(name),
          .value = value,
          .loop = findControl(device, loopId),
          .loopOn = 1,
          .loopOff = 0};
}

Pair exposurePair(const Device& device) {
  Pair pair{.name = "exposure",
            .value = findControl(device, V4L2_CID_EXPOSURE_ABSOLUTE),
            .loop = findControl(device, V4L2_CID_EXPOSURE_AUTO)};
  if (!pair.loop) return pair;
  const auto firstOf = [&](std::initializer_list<std::int64_t> items) {
    const auto* found = std::ranges::find_if(
        items, [&](std::int64_t item) { return hasMenuItem(device, *pair.loop, item); });
    return found == items.end() ? std::nullopt : std::optional(*found);
  };
  pair.loopOn = firstOf({V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY});
  pair.loopOff = firstOf({V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_SHUTTER_PRIORITY});
  return pair;
}

Pair gainPair(const Device& device) {
  std::optional<Control> value = findControl(device, V4L2_CID_GAIN);
  if (!value) value = findControl(device, V4L2_CID_ANALOGUE_GAIN);
  return switchPair(device, "gain", value, V4L2_CID_AUTOGAIN);
}

Pair focusPair(const Device& device) {
  return switchPair(device, "focus", findControl(device, V4L2_CID_FOCUS_ABSOLUTE),
                    V4L2_CID_FOCUS_AUTO);
}

Pair whiteBalancePair(const Device& device) {
  return switchPair(device, "white_balance",
                    findControl(device, V4L2_CID_WHITE_BALANCE_TEMPERATURE),
                    V4L2_CID_AUTO_WHITE_BALANCE);
}

Error missing(const Device& device, const std::string& what) {
  std::string has;
  for (const Pair& pair :
       {exposurePair(device), gainPair(device), focusPair(device), whiteBalancePair(device)}) {
    if (!pair.value && !pair.loop) continue;
    has += has.empty() ? "" : ", ";
    has += pair.name;
    if (!pair.value) has += " (auto only)";
    if (!pair.loop) has += " (no auto)";
  }
  return {.kind = ErrorKind::kUnsupported,
          .subject = device.node(),
          .problem = "has no control of " + what + " (" + device.capability().card + ")",
          .remedy = has.empty() ? "remove the setting; the device has no such controls"
                                : "remove the setting; the device has " + has};
}

Result<void> setAutomatic(const Device& device, const Pair& pair) {
  if (!pair.loop || !pair.loopOn) {
    return tl::unexpected(missing(device, "automatic " + pair.name));
  }
  return set(device, pair.loop->id, *pair.loopOn, pair.name);
}

Result<void> setValue(const Device& device, const Pair& pair, double value) {
  if (!pair.value) return tl::unexpected(missing(device, pair.name));
  if (pair.loop && pair.loopOff) {
    if (Result<void> off = set(device, pair.loop->id, *pair.loopOff, pair.name); !off) return off;
  }
  return set(device, pair.value->id, onStep(*pair.value, value), pair.name);
}

/// Converts a share of a control's range to the control's units.
double ofRange(const Pair& pair, double share) {
  if (!pair.value) return 0;
  const auto min = static_cast<double>(pair.value->min);
  return min + share * (static_cast<double>(pair.value->max) - min);
}

template <class T, class ToUnits>
Result<void> apply(const Device& device, const Pair& pair, const AutomaticOr<T>& wanted,
                   ToUnits toUnits) {
  if (std::holds_alternative<Automatic>(wanted)) return setAutomatic(device, pair);
  return setValue(device, pair, toUnits(std::get<T>(wanted)));
}

}  // namespace

Result<void> setControls(const Device& device, const CameraControls& controls) {
  if (controls.exposure) {
    const auto ticks = [](Duration time) { return ExposureTicks(time).count(); };
    auto done = apply(device, exposurePair(device), *controls.exposure, ticks);
    if (!done) return done;
  }
  const auto applyShare = [&](const Pair& pair, const AutomaticOr<double>& wanted) {
    return apply(device, pair, wanted, [&](double share) { return ofRange(pair, share); });
  };
  if (controls.gain) {
    if (auto done = applyShare(gainPair(device), *controls.gain); !done) return done;
  }
  if (controls.focus) {
    if (auto done = applyShare(focusPair(device), *controls.focus); !done) return done;
  }
  if (!controls.whiteBalance) return {};
  return apply(device, whiteBalancePair(device), *controls.whiteBalance,
               [](double kelvin) { return kelvin; });
}

}  // namespace pleinair::hal::v4l2
