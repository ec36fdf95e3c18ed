#pragma once

#include <optional>

namespace pleinair::measure {

/// A running mean over pixels, marks or frames.
struct Mean {
  double sum = 0;
  double weight = 0;

  Mean& operator+=(const Mean& other) {
    sum += other.sum;
    weight += other.weight;
    return *this;
  }
  /// Nothing if nothing was counted.
  std::optional<double> value() const {
    return weight > 0 ? std::optional(sum / weight) : std::nullopt;
  }
};

/// a / b; nothing if one is unknown or b is zero.
inline std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b || *b == 0) return std::nullopt;
  return *a / *b;
}

/// A share as a percentage; nothing if nothing was counted.
inline std::optional<double> percentOf(const Mean& share) {
  const std::optional<double> value = share.value();
  return value ? std::optional(100.0 * *value) : std::nullopt;
}

}  // namespace pleinair::measure
