#include "firmware_app/live/interaction/parameter_step.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>

#include <fmt/format.h>

namespace pleinair::app {
namespace {

using config::ChoiceIndex;
using config::NumberRange;
using config::ParameterDescriptor;
using config::ParameterValue;

constexpr int kLargeFactor = 10;
constexpr double kStepsPerRange = 100.0;

/// 1, 2 or 5 times a power of ten.
struct Step {
  int digit = 1;
  int exponent = 0;
  double size() const { return digit * std::pow(10.0, exponent); }
};

/// The largest step that is not above `size`, apart from rounding.
Step roundStep(double size) {
  Step step{.digit = 1, .exponent = static_cast<int>(std::floor(std::log10(size) + 1e-9))};
  const double leading = size / std::pow(10.0, step.exponent) + 1e-9;
  if (leading >= 2) step.digit = 2;
  if (leading >= 5) step.digit = 5;
  return step;
}

/// A hundredth of the range; if that is infinite, a hundredth of the value or of 1, the larger.
Step stepOf(const NumberRange& range, double value) {
  const double span = range.max - range.min;
  if (std::isfinite(span) && span > 0.0) return roundStep(span / kStepsPerRange);
  return roundStep(std::max(std::abs(value), 1.0) / kStepsPerRange);
}

/// The double nearest to the decimal that people read: 0.3, not 0.30000000000000004.
double asDecimal(double value, int decimals) {
  const std::string text = fmt::format("{:.{}f}", value, std::max(0, decimals));
  double decimal = value;
  std::from_chars(text.data(), text.data() + text.size(), decimal);
  return decimal == 0.0 ? 0.0 : decimal;  // no −0
}

double steppedNumber(const NumberRange& range, double value, int direction, bool large) {
  const Step step = stepOf(range, value);
  const double size = step.size() * (large ? kLargeFactor : 1);
  // The next multiple in that direction; one within the tolerance counts as reached.
  constexpr double kTolerance = 1e-6;
  const double multiples = value / size;
  const double next = direction > 0 ? std::floor(multiples + kTolerance) + 1.0
                                    : std::ceil(multiples - kTolerance) - 1.0;
  return std::clamp(asDecimal(next * size, -step.exponent), range.min, range.max);
}

int steppedInteger(const config::IntegerRange& range, int value, int direction, bool large) {
  const long long distance = large ? kLargeFactor : 1;
  const long long next = value + direction * distance;
  return static_cast<int>(std::clamp<long long>(next, range.min, range.max));
}

std::size_t steppedChoice(std::size_t count, std::size_t index, int direction) {
  return (index + (direction > 0 ? 1 : count - 1)) % count;
}

}  // namespace

std::optional<ParameterValue> stepped(const ParameterDescriptor& descriptor,
                                      const ParameterValue& value, int direction, bool large) {
  ParameterValue next = value;
  if (const auto* number = std::get_if<double>(&value)) {
    next = steppedNumber(descriptor.numberRange, *number, direction, large);
  } else if (const auto* integer = std::get_if<int>(&value)) {
    next = steppedInteger(descriptor.integerRange, *integer, direction, large);
  } else if (const auto* choice = std::get_if<ChoiceIndex>(&value)) {
    next = ChoiceIndex{steppedChoice(descriptor.choices.size(), choice->index, direction)};
  } else if (const auto* isOn = std::get_if<bool>(&value)) {
    next = !*isOn;
  } else {
    return std::nullopt;  // texts, paths and sizes have no next one
  }
  if (next == value || !descriptor.allows(next)) return std::nullopt;
  return next;
}

}  // namespace pleinair::app
