#include "firmware_app/cli/option_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace pleinair::app {
namespace {

/// A year at 30 frames per second.
constexpr std::uint64_t kMaxFrames = 1'000'000'000;

std::string foundText(std::string_view text, std::string_view allowed) {
  return fmt::format("found \"{}\", allowed: {}", text, allowed);
}

/// Parses the whole text as a number with an optional sign.
std::optional<double> signedNumber(std::string_view text) {
  double number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool isNumber = status == std::errc() && end == text.data() + text.size();
  return isNumber ? std::optional(number) : std::nullopt;
}

/// Parses digits at the front of the text, without a sign, and removes them.
template <class Number>
bool takeNumber(std::string_view& text, Number& number) {
  // from_chars would accept a sign.
  if (text.empty() || text.front() < '0' || text.front() > '9') return false;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return status == std::errc();
}

}  // namespace

std::uint64_t frameCountOf(const std::string& text, const std::string& option,
                           std::uint64_t least) {
  std::uint64_t count = 0;
  std::string_view rest = text;
  if (takeNumber(rest, count) && rest.empty() && count >= least && count <= kMaxFrames)
    return count;
  throw CLI::ValidationError(
      option, foundText(text, fmt::format("a whole number from {} to {}", least, kMaxFrames)));
}

double numberOf(const std::string& option, const std::string& text, std::string_view unit,
                double least, double most) {
  std::string_view rest = text;
  if (!unit.empty() && rest.ends_with(unit)) rest.remove_suffix(unit.size());
  const std::optional<double> number = signedNumber(rest);
  if (number && *number >= least && *number <= most) return *number;  // false for NaN
  throw CLI::ValidationError(
      option, foundText(text, fmt::format("a number from {:g} to {:g}{}{}", least, most,
                                          unit.empty() ? "" : " ", unit)));
}

hal::Duration timeOf(const std::string& option, const std::string& text) {
  constexpr double kMostSeconds = 1e6;
  double seconds = 0;
  std::string_view rest = text;
  bool isTime = std::ranges::count(text, ':') <= 2;
  for (bool isLast = false; isTime && !isLast;) {
    const std::size_t colon = rest.find(':');
    isLast = colon == std::string_view::npos;
    const std::optional<double> part = signedNumber(rest.substr(0, colon));
    const bool isFirst = rest.size() == text.size();
    isTime =
        part && *part >= 0 && (isFirst || *part < 60) && (isLast || *part == std::floor(*part));
    if (isTime) seconds = 60 * seconds + *part;
    if (!isLast) rest.remove_prefix(colon + 1);
  }
  if (isTime && seconds <= kMostSeconds) return hal::fromSeconds(seconds);
  throw CLI::ValidationError(option,
                             foundText(text, "seconds such as 12.5, or 1:02.5, or 1:00:02.5"));
}

std::pair<double, double> vectorOf(const std::string& option, const std::string& text,
                                   double most) {
  const std::string_view whole = text;
  const std::size_t comma = std::min(whole.find(','), whole.size());
  const std::optional<double> x = signedNumber(whole.substr(0, comma));
  const std::optional<double> y = signedNumber(whole.substr(std::min(comma + 1, whole.size())));
  if (x && y && std::abs(*x) <= most && std::abs(*y) <= most) return {*x, *y};
  throw CLI::ValidationError(
      option, foundText(text, fmt::format("two numbers from {:g} to {:g}, such as -1.5,-0.5", -most,
                                          most)));
}

std::string refuseStandardOutput(const std::string& text) {
  if (text != "-") return {};
  return foundText(text, "the name of a file; nothing is written to standard output");
}

namespace {

std::string requireEnding(const std::string& text, std::string_view ending,
                          std::string_view upper) {
  if (text.empty()) return {};  // refuseEmptyValues() gives the better message
  const std::filesystem::path has = std::filesystem::path(text).extension();
  if (has == ending || has == upper) return {};
  return foundText(text, fmt::format("a name that ends in {}", ending));
}

}  // namespace

std::string requirePngName(const std::string& text) {
  return requireEnding(text, ".png", ".PNG");
}

std::string requirePdfName(const std::string& text) {
  return requireEnding(text, ".pdf", ".PDF");
}

void refuseEmptyValues(CLI::App& command) {
  for (CLI::Option* option : command.get_options()) {
    if (option->get_items_expected_max() == 0) continue;  // a flag
    const char* remedy =
        option->get_required() ? "give it a value" : "give it a value or leave it out";
    option->check([remedy](const std::string& text) {
      return text.empty() ? fmt::format("is empty, {}", remedy) : std::string();
    });
  }
}

}  // namespace pleinair::app
