#include "firmware_app/config/control_text.h"

#include <cassert>
#include <charconv>
#include <system_error>

namespace pleinair::app {
namespace {

constexpr std::string_view kAutomatic = "auto";
constexpr std::string_view kDevices = "device";

std::optional<double> numberOf(std::string_view text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [stop, failure] = std::from_chars(text.data(), end, value);
  return failure == std::errc() && stop == end ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string ControlText::allowed() const {
  return std::string(kAutomatic) + ", " + std::string(kDevices) + ", or " + range.describe();
}

bool ControlText::takes(std::string_view text) const {
  if (text == kAutomatic || text == kDevices) return true;
  const std::optional<double> number = numberOf(text);
  return number && range.contains(*number);
}

std::optional<hal::AutomaticOr<double>> ControlText::parsed(std::string_view text) const {
  assert(takes(text));
  if (text == kDevices) return std::nullopt;
  if (text == kAutomatic) return hal::Automatic{};
  return *numberOf(text);
}

}  // namespace pleinair::app
