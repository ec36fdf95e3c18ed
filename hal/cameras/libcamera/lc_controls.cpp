#include "hal/cameras/libcamera/lc_controls.h"

#include <chrono>
#include <cstdint>
#include <variant>

namespace pleinair::hal::libcamera {
namespace {

double numberIn(const lc::ControlValue& value) {
  switch (value.type()) {
    case lc::ControlTypeInteger32:
      return value.get<std::int32_t>();
    case lc::ControlTypeInteger64:
      return static_cast<double>(value.get<std::int64_t>());
    case lc::ControlTypeFloat:
      return static_cast<double>(value.get<float>());
    default:
      return 0;
  }
}

const lc::ControlId* valueControl(Control control) {
  switch (control) {
    case Control::kExposure:
      return &lc::controls::ExposureTime;
    case Control::kGain:
      return &lc::controls::AnalogueGain;
    case Control::kFocus:
      return &lc::controls::LensPosition;
    case Control::kWhiteBalance:
      return &lc::controls::ColourTemperature;
  }
  return nullptr;
}

const lc::ControlId* automaticControl(Control control) {
  switch (control) {
    case Control::kExposure:
#if PLEINAIR_LIBCAMERA_VERSION >= 500
      return &lc::controls::ExposureTimeMode;
#else
      return &lc::controls::AeEnable;
#endif
    case Control::kGain:
#if PLEINAIR_LIBCAMERA_VERSION >= 500
      return &lc::controls::AnalogueGainMode;
#else
      return &lc::controls::AeEnable;
#endif
    case Control::kFocus:
      return &lc::controls::AfMode;
    case Control::kWhiteBalance:
      return &lc::controls::AwbEnable;
  }
  return nullptr;
}

const lc::ControlInfo* infoOf(const lc::Camera& camera, const lc::ControlId* id) {
  const auto found = camera.controls().find(id);
  return found == camera.controls().end() ? nullptr : &found->second;
}

void add(const lc::Camera& camera, Control control, const AutomaticOr<double>& setting,
         lc::ControlList& controls) {
  const bool isAutomatic = std::holds_alternative<Automatic>(setting);
  const lc::ControlId* const automatic = automaticControl(control);
  if (infoOf(camera, automatic) != nullptr) {
    if (control == Control::kFocus) {
      controls.set(lc::controls::AfMode, isAutomatic ? std::int32_t{lc::controls::AfModeContinuous}
                                                     : std::int32_t{lc::controls::AfModeManual});
#if PLEINAIR_LIBCAMERA_VERSION >= 500
    } else if (control == Control::kExposure) {
      controls.set(lc::controls::ExposureTimeMode, isAutomatic
                                                       ? lc::controls::ExposureTimeModeAuto
                                                       : lc::controls::ExposureTimeModeManual);
    } else if (control == Control::kGain) {
      controls.set(lc::controls::AnalogueGainMode, isAutomatic
                                                       ? lc::controls::AnalogueGainModeAuto
                                                       : lc::controls::AnalogueGainModeManual);
#endif
    } else {
      controls.set(automatic->id(), lc::ControlValue(isAutomatic));
    }
  }
  if (isAutomatic) return;
  const double value = std::get<double>(setting);
  const lc::ControlId* const id = valueControl(control);
  if (id->type() == lc::ControlTypeFloat) {
    controls.set(id->id(), lc::ControlValue(static_cast<float>(value)));
  } else {
    controls.set(id->id(), lc::ControlValue(static_cast<std::int32_t>(value)));
  }
}

}  // namespace

std::optional<ControlRange> rangeOf(const lc::Camera& camera, Control control) {
  const lc::ControlInfo* const info = infoOf(camera, valueControl(control));
  if (info == nullptr) return std::nullopt;
  return ControlRange{.min = numberIn(info->min()), .max = numberIn(info->max())};
}

bool hasAutomatic(const lc::Camera& camera, Control control) {
  return infoOf(camera, automaticControl(control)) != nullptr;
}

std::optional<std::array<Duration, 2>> periodsOf(const lc::Camera& camera) {
  const lc::ControlInfo* const info = infoOf(camera, &lc::controls::FrameDurationLimits);
  if (info == nullptr) return std::nullopt;
  const auto microseconds = [](const lc::ControlValue& value) {
    return Duration(std::chrono::microseconds(static_cast<std::int64_t>(numberIn(value))));
  };
  return std::array{microseconds(info->min()), microseconds(info->max())};
}

lc::ControlList controlsOf(const lc::Camera& camera, const StartSettings& settings) {
  lc::ControlList controls(camera.controls());
  for (const Control control : kControls) {
    const auto& setting = settings.controls.at(static_cast<std::size_t>(control));
    if (setting) add(camera, control, *setting, controls);
  }
  if (settings.framePeriod) {
    const auto period =
        std::chrono::duration_cast<std::chrono::microseconds>(*settings.framePeriod).count();
    const std::array<std::int64_t, 2> limits{period, period};
    controls.set(lc::controls::FrameDurationLimits, lc::Span<const std::int64_t, 2>(limits));
  }
  return controls;
}

}  // namespace pleinair::hal::libcamera
