#include "config/value_range.h"

#include <cmath>

#include <fmt/format.h>

namespace pleinair::config {
namespace {

std::string ofUnit(std::string_view unit) {
  return unit.empty() ? std::string() : fmt::format(" of {}", unit);
}

}  // namespace

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  return (minOpen ? value > min : value >= min) && (maxOpen ? value < max : value <= max);
}

std::string NumberRange::describe(bool plural) const {
  std::string text = (plural ? "numbers" : "a number") + ofUnit(unit);
  const bool bounded = std::isfinite(min);
  if (bounded && std::isfinite(max)) {
    text += fmt::format(" in {}{}, {}{}", minOpen ? '(' : '[', min, max, maxOpen ? ')' : ']');
  } else if (bounded) {
    text += fmt::format(" {} {}", minOpen ? "above" : "at least", min);
  } else if (std::isfinite(max)) {
    text += fmt::format(" {} {}", maxOpen ? "below" : "at most", max);
  }
  return text;
}

std::string IntegerRange::describe() const {
  std::string text = "a whole number" + ofUnit(unit);
  const bool bounded = min != std::numeric_limits<int>::min();
  if (max != std::numeric_limits<int>::max()) {
    text += bounded ? fmt::format(" in [{}, {}]", min, max) : fmt::format(" at most {}", max);
  } else if (bounded) {
    text += fmt::format(" at least {}", min);
  }
  return text;
}

bool SizeRange::contains(PixelSize size) const {
  const auto fits = [&](int side) { return side >= 1 && side <= maxSide; };
  return fits(size.width) && fits(size.height) &&
         static_cast<long long>(size.width) * size.height <= maxPixels;
}

std::string SizeRange::describe() const {
  std::string text = fmt::format("WIDTHxHEIGHT, at most {} px a side", maxSide);
  if (maxPixels < static_cast<long long>(maxSide) * maxSide) {
    text += fmt::format(" and {} Mpx", maxPixels / 1'000'000);
  }
  return text + ", such as 1280x720";
}

std::string LengthRange::describe(std::string_view elements) const {
  if (min == max) return fmt::format("an array of {} {}", min, elements);
  if (max != std::numeric_limits<std::size_t>::max()) {
    return fmt::format("an array of {} to {} {}", min, max, elements);
  }
  return min == 0 ? fmt::format("an array of {}", elements)
                  : fmt::format("an array of at least {} {}", min, elements);
}

}  // namespace pleinair::config
