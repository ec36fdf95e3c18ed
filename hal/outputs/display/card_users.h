#pragma once

#include <filesystem>
#include <string>

namespace pleinair::hal::display {

/// The other programs that have a card open, as far as this user may see: "Xorg (712), kmscube
/// (801)". Empty where none is seen.
std::string usersText(const std::string& node, const std::filesystem::path& proc = "/proc");

}  // namespace pleinair::hal::display
