#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "config/value_range.h"
#include "hal/camera.h"

namespace pleinair::app {

/// How a configuration writes one of a camera's controls: "auto", "device" (as the device has it),
/// or a number of this range.
struct ControlText {
  config::NumberRange range;

  /// "auto, device, or a number of ms in (0, 10000]".
  std::string allowed() const;
  bool takes(std::string_view text) const;
  /// Unset for "device". Precondition: takes(text).
  std::optional<hal::AutomaticOr<double>> parsed(std::string_view text) const;
};

inline constexpr ControlText kExposureText{
    {.min = 0, .max = 10'000, .minOpen = true, .unit = "ms"}};
inline constexpr ControlText kShareText{{.min = 0, .max = 1}};  ///< gain, focus
inline constexpr ControlText kWhiteBalanceText{{.min = 1000, .max = 20'000, .unit = "K"}};

}  // namespace pleinair::app
