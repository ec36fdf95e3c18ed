#include "pipeline/procedure/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <vector>

#include "config/suggestion.h"

namespace pleinair::procedure {
namespace {

struct TorqueUnit {
  const char* name;
  double newtonMetres;
};
// Exact by the definitions of pound (0.45359237 kg), inch (0.0254 m) and standard gravity.
constexpr double kPoundForce = 0.45359237 * 9.80665;
constexpr std::array<TorqueUnit, 6> kTorqueUnits{{{"Nm", 1.0},
                                                  {"cNm", 0.01},
                                                  {"kNm", 1000.0},
                                                  {"kgf m", 9.80665},
                                                  {"lbf ft", kPoundForce * 0.3048},
                                                  {"lbf in", kPoundForce * 0.0254}}};

constexpr double kMaxNewtonMetres = 1e6;

void skipSpaces(std::string_view& text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
}

std::optional<double> takeNumber(std::string_view& text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || !std::isfinite(value)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(result.ptr - text.data()));
  skipSpaces(text);
  return value;
}

bool takeWord(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  skipSpaces(text);
  return true;
}

}  // namespace

std::span<const std::string> torqueUnits() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const TorqueUnit& unit : kTorqueUnits) names.emplace_back(unit.name);
    return names;
  }();
  return kNames;
}

std::span<const std::string> valueUnits() {
  static const std::vector<std::string> kNames{
      "mm", "cm",  "m",   "µm",  "in",  "mm²", "°",  "deg", "°C", "°F", "K",  "Nm",  "N",
      "kN", "bar", "kPa", "MPa", "psi", "V",   "mV", "A",   "mA", "Ω",  "kΩ", "MΩ",  "W",
      "Hz", "rpm", "s",   "min", "h",   "g",   "kg", "l",   "ml", "dB", "%",  "mm/s"};
  return kNames;
}

TorqueReading readTorque(std::string_view text) {
  TorqueReading reading;
  std::string_view rest = text;
  skipSpaces(rest);
  const std::optional<double> value = takeNumber(rest);
  if (!value) return {.problem = "is no number with a unit"};
  std::optional<double> tolerance = 0.0;
  if (takeWord(rest, "±") || takeWord(rest, "+-") || takeWord(rest, "+/-")) {
    tolerance = takeNumber(rest);
    if (!tolerance) return {.problem = "has no number after ±"};
  }
  while (rest.ends_with(' ')) rest.remove_suffix(1);
  if (rest.empty()) return {.problem = "has no unit"};
  for (const TorqueUnit& unit : kTorqueUnits) {
    if (rest != unit.name) continue;
    const double newtonMetres = *value * unit.newtonMetres;
    if (!(newtonMetres > 0.0 && newtonMetres <= kMaxNewtonMetres)) {
      return {.problem = "is not above 0 and up to 1000 kNm"};
    }
    if (!(*tolerance >= 0.0 && *tolerance < *value)) {
      return {.problem = "has a tolerance that is not from 0 to below its value"};
    }
    return {.torque = Torque{.text = std::string(text),
                             .newtonMetres = newtonMetres,
                             .toleranceNewtonMetres = *tolerance * unit.newtonMetres}};
  }
  return {.problem = "has the unknown unit " + config::foundText(rest, torqueUnits())};
}

}  // namespace pleinair::procedure
