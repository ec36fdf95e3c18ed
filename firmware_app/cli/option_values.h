#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/App.hpp>

namespace pleinair::app {

/// A whole number from `least` on. Throws CLI::ValidationError of `option`, which says the limits.
std::uint64_t frameCountOf(const std::string& text, const std::string& option = "--frames",
                           std::uint64_t least = 1);

/// A number within limits, with a unit after it or without. Throws CLI::ValidationError, which says
/// what is allowed of `option`.
double numberOf(const std::string& option, const std::string& text, std::string_view unit,
                double least, double most);
/// "X,Y", neither beyond ± `most`. Likewise.
std::pair<double, double> vectorOf(const std::string& option, const std::string& text, double most);

// Checks for CLI::Option::check(): empty, or what is wrong.

/// "-" would make a file or a folder of that name.
std::string refuseStandardOutput(const std::string& text);
/// Names that end in .png or .PNG.
std::string requirePngName(const std::string& text);

/// Adds a check against empty values to each option of the command that takes one.
void refuseEmptyValues(CLI::App& command);

}  // namespace pleinair::app
