#include "hal/cameras/v4l2/controls.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <linux/videodev2.h>

#include "hal/cameras/missing_control.h"

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
  return Control{.id = id,
                 .min = query.minimum,
                 .max = std::max(query.minimum, query.maximum),
                 .step = std::max(query.step, 1)};
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

/// Sets a control and reads it back: some devices take a value without a word and keep another.
/// Gives a line where that differs; empty: it is as set.
Result<std::string> set(const Device& device, const Control& set, std::int64_t value,
                        const std::string& name) {
  v4l2_control control{};
  control.id = set.id;
  control.value = static_cast<std::int32_t>(value);
  if (const int answer = device.ask(VIDIOC_S_CTRL, control); answer < 0) {
    return tl::unexpected(device.failure("cannot set its " + name, answer));
  }
  control = {};
  control.id = set.id;
  // Not all can be read.
  if (device.ask(VIDIOC_G_CTRL, control) < 0) return std::string();
  if (std::abs(control.value - value) < set.step) return std::string();
  return "keeps its " + name + " at " + std::to_string(control.value) + " where " +
         std::to_string(value) + " was set (" + std::to_string(set.min) + " to " +
         std::to_string(set.max) + ")";
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
  const std::array pairs{exposurePair(device), gainPair(device), focusPair(device),
                         whiteBalancePair(device)};
  std::array<OfferedControl, pairs.size()> offered;
  std::ranges::transform(pairs, offered.begin(), [](const Pair& pair) -> OfferedControl {
    return {.name = pair.name,
            .hasValue = pair.value.has_value(),
            .hasAutomatic = pair.loop.has_value()};
  });
  Error error = missingControl(what, offered);
  error.subject = device.node();
  error.problem += " (" + device.capability().card + ")";
  return error;
}

Result<std::string> setAutomatic(const Device& device, const Pair& pair) {
  if (!pair.loop || !pair.loopOn) {
    return tl::unexpected(missing(device, "automatic " + pair.name));
  }
  return set(device, *pair.loop, *pair.loopOn, "automatic " + pair.name);
}

Result<std::string> setValue(const Device& device, const Pair& pair, double value) {
  if (!pair.value) return tl::unexpected(missing(device, pair.name));
  if (pair.loop && pair.loopOff) {
    Result<std::string> off = set(device, *pair.loop, *pair.loopOff, "automatic " + pair.name);
    if (!off || !off->empty()) return off;
  }
  return set(device, *pair.value, onStep(*pair.value, value), pair.name);
}

/// Converts a share of a control's range to the control's units.
double ofRange(const Pair& pair, double share) {
  if (!pair.value) return 0;
  const auto min = static_cast<double>(pair.value->min);
  return min + share * (static_cast<double>(pair.value->max) - min);
}

template <class T, class ToUnits>
Result<std::string> apply(const Device& device, const Pair& pair, const AutomaticOr<T>& wanted,
                          ToUnits toUnits) {
  if (std::holds_alternative<Automatic>(wanted)) return setAutomatic(device, pair);
  return setValue(device, pair, toUnits(std::get<T>(wanted)));
}

std::string_view nameOf(PowerLine powerLine) {
  switch (powerLine) {
    case PowerLine::kOff:
      return "off";
    case PowerLine::k50Hz:
      return "50";
    case PowerLine::k60Hz:
      return "60";
    case PowerLine::kAuto:
      return "auto";
  }
  return "";
}

std::int64_t itemOf(PowerLine powerLine) {
  switch (powerLine) {
    case PowerLine::k50Hz:
      return V4L2_CID_POWER_LINE_FREQUENCY_50HZ;
    case PowerLine::k60Hz:
      return V4L2_CID_POWER_LINE_FREQUENCY_60HZ;
    case PowerLine::kAuto:
      return V4L2_CID_POWER_LINE_FREQUENCY_AUTO;
    default:
      return V4L2_CID_POWER_LINE_FREQUENCY_DISABLED;
  }
}

Result<std::string> setPowerLine(const Device& device, PowerLine wanted) {
  const std::optional<Control> control = findControl(device, V4L2_CID_POWER_LINE_FREQUENCY);
  if (control && hasMenuItem(device, *control, itemOf(wanted))) {
    return set(device, *control, itemOf(wanted), "power_line");
  }
  std::string has;
  for (const PowerLine each :
       {PowerLine::kOff, PowerLine::k50Hz, PowerLine::k60Hz, PowerLine::kAuto}) {
    if (!control || !hasMenuItem(device, *control, itemOf(each))) continue;
    has += has.empty() ? "" : ", ";
    has += nameOf(each);
  }
  return tl::unexpected(
      Error{.kind = ErrorKind::kUnsupported,
            .subject = device.node(),
            .problem = "has no power_line \"" + std::string(nameOf(wanted)) + "\" (" +
                       device.capability().card + ")",
            .remedy = has.empty() ? "remove camera.v4l2.power_line; the device has no such control"
                                  : "set camera.v4l2.power_line to one of " + has});
}

}  // namespace

Result<std::string> setControls(const Device& device, const CameraControls& controls,
                                std::optional<PowerLine> powerLine) {
  std::string differences;
  // Notes a difference; false after an error.
  const auto isDone = [&](const Result<std::string>& done) {
    if (done && !done->empty()) differences += (differences.empty() ? "" : "; ") + *done;
    return done.has_value();
  };
  const auto share = [&](const Pair& pair, const AutomaticOr<double>& wanted) {
    return apply(device, pair, wanted, [&](double part) { return ofRange(pair, part); });
  };
  if (powerLine) {
    // Before the exposure, which is a multiple of the lamps' period for some devices.
    if (auto done = setPowerLine(device, *powerLine); !isDone(done)) return done;
  }
  if (controls.exposure) {
    const auto ticks = [](Duration time) { return ExposureTicks(time).count(); };
    auto done = apply(device, exposurePair(device), *controls.exposure, ticks);
    if (!isDone(done)) return done;
  }
  if (controls.gain) {
    if (auto done = share(gainPair(device), *controls.gain); !isDone(done)) return done;
  }
  if (controls.focus) {
    if (auto done = share(focusPair(device), *controls.focus); !isDone(done)) return done;
  }
  if (controls.whiteBalance) {
    auto done = apply(device, whiteBalancePair(device), *controls.whiteBalance,
                      [](double kelvin) { return kelvin; });
    if (!isDone(done)) return done;
  }
  return differences;
}

}  // namespace pleinair::hal::v4l2
