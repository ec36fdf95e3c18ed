#pragma once

#include <string>
#include <string_view>

namespace pleinair::hal::display {

inline constexpr std::string_view kDisplayName = "display";

/// What "display", "display:HDMI-A-1" and "display:card1-HDMI-A-1" say.
struct DisplayName {
  std::string card;       ///< "card1"; empty: any
  std::string connector;  ///< "HDMI-A-1"; empty: the first connected

  /// Whether a card's node can be meant.
  bool isOn(std::string_view node) const {
    return card.empty() || node.substr(node.rfind('/') + 1) == card;
  }
};

/// Whether it is one of the forms above.
bool isDisplayName(const std::string& name);
/// Precondition: isDisplayName().
DisplayName parseDisplayName(const std::string& name);

}  // namespace pleinair::hal::display
