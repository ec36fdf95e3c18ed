#pragma once

#include <cstdint>
#include <string>

#include <CLI/App.hpp>

namespace pleinair::app {

/// A whole number from 1. Throws CLI::ValidationError, which says the limits.
std::uint64_t frameCountOf(const std::string& text);

// Checks for CLI::Option::check(): empty, or what is wrong.

/// "-" would make a file or a folder of that name.
std::string refuseStandardOutput(const std::string& text);
/// Names that end in .png or .PNG.
std::string requirePngName(const std::string& text);

/// Adds a check against empty values to each option of the command that takes one.
void refuseEmptyValues(CLI::App& command);

}  // namespace pleinair::app
