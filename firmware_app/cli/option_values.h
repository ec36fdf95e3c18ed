#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include <CLI/App.hpp>

#include "hal/clock.h"

namespace pleinair::app {

/// Parses a whole number of at least `least`. Throws CLI::ValidationError for `option`, with the
/// limits.
std::uint64_t frameCountOf(const std::string& text, const std::string& option = "--frames",
                           std::uint64_t least = 1);

/// Parses a number within limits, with or without its unit. Throws CLI::ValidationError for
/// `option`, with the limits.
double numberOf(const std::string& option, const std::string& text, std::string_view unit,
                double least, double most);
/// Parses a moment of a recording: seconds, such as "12.5", or with minutes and hours, "1:02:03.5".
/// Throws CLI::ValidationError for `option`.
hal::Duration timeOf(const std::string& option, const std::string& text);
/// Parses "X,Y", both within ± `most`. Throws CLI::ValidationError for `option`, with the limits.
std::pair<double, double> vectorOf(const std::string& option, const std::string& text, double most);

// Checks for CLI::Option::check(). Each gives an empty string, or the error text.

/// Refuses "-", which would create a file or folder of that name.
std::string refuseStandardOutput(const std::string& text);
/// Requires a name that ends in .png or .PNG.
std::string requirePngName(const std::string& text);
/// Requires a name that ends in .pdf or .PDF.
std::string requirePdfName(const std::string& text);

/// Adds a check against empty values to each option of the subcommand that takes a value.
void refuseEmptyValues(CLI::App& command);

}  // namespace pleinair::app
