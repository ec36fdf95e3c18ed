#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/outputs/display/card.h"

namespace pleinair::hal::display {

inline constexpr std::string_view kDisplayName = "display";

/// A display's name: "display", "display:HDMI-A-1" or "display:card1-HDMI-A-1".
struct DisplayName {
  std::string card;       ///< "card1"; empty: any
  std::string connector;  ///< "HDMI-A-1"; empty: the first connected

  /// Whether a card's node can be meant.
  bool isOn(std::string_view node) const {
    return card.empty() || node.substr(node.rfind('/') + 1) == card;
  }
};

/// Whether a text has one of these forms.
bool isDisplayName(const std::string& name);
/// Precondition: isDisplayName().
DisplayName parseDisplayName(const std::string& name);

/// What is asked of a display.
struct DisplayRequest {
  std::string connector;  ///< "HDMI-A-1"; empty: the first that is connected
  /// "auto": the preferred size at the rate that fits the camera's best; "preferred"; "1920x1080",
  /// the fastest of that size; "1920x1080@60", the nearest to that rate.
  std::string mode = "auto";
  std::optional<Duration> framePeriod;  ///< the camera's
};

/// How a picture reaches a display: which parts of the card show it.
struct DisplayRoute {
  Connector connector;
  Crtc crtc;
  Plane plane;
  Mode mode;
  std::size_t crtcIndex = 0;   ///< of the card's
  std::size_t planeIndex = 0;  ///< of the card's
};

/// A bit for each CRTC and plane of a card, by index, that another output uses.
struct InUse {
  std::uint32_t crtcs = 0;
  std::uint64_t planes = 0;
};

/// The connector by its name, or the first connected one that is free. Errors: kNotFound (no such
/// connector: lists those there are), kDeviceLost (nothing is plugged in), kBusy (another output
/// has it).
Result<Connector> chooseConnector(const CardState& card, const std::string& name,
                                  std::span<const ObjectId> taken);

/// Whether it is a DisplayRequest::mode.
bool isModeText(const std::string& text);

/// Precondition: there are modes. Errors: kInvalidArgument (what is no mode), kNotFound (the
/// display has no such mode: lists the sizes).
Result<Mode> chooseMode(const Connector& connector, const DisplayRequest& request);

/// A free CRTC for the connector, preferably the one that drives it now, and that CRTC's primary
/// plane. Errors: kBusy (all are in use), kUnsupported (no plane takes XRGB8888).
Result<DisplayRoute> routeTo(const CardState& card, const Connector& connector, const Mode& mode,
                             const InUse& inUse);

}  // namespace pleinair::hal::display
