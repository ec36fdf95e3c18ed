#pragma once

#include <filesystem>
#include <string>

#include "hal/error.h"

namespace pleinair::hal::display {

/// kNotFound: the machine has no graphics card that shows pictures.
Error noCard(std::string subject);
/// kBusy: another program is the card's master; names those that have it open.
Error notMaster(const std::string& node, std::string subject);

/// The problem of a kBusy error: another virtual terminal has the display.
inline constexpr const char* kOtherConsole = "another console is in front";

/// The other programs that have a card open, as far as this user may see: "Xorg (712), kmscube
/// (801)". Empty where none is seen.
std::string usersText(const std::string& node, const std::filesystem::path& proc = "/proc");

}  // namespace pleinair::hal::display
