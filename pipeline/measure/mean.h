#pragma once

#include <optional>

namespace pleinair::measure {

/// A mean that goes on: over pixels, marks or frames.
struct Mean {
  double sum = 0;
  double weight = 0;

  Mean& operator+=(const Mean& other) {
    sum += other.sum;
    weight += other.weight;
    return *this;
  }
  /// Nothing where nothing was counted.
  std::optional<double> value() const {
    return weight > 0 ? std::optional(sum / weight) : std::nullopt;
  }
};

/// a / b; nothing where one is not known, or b is zero.
std::optional<double> ratio(std::optional<double> a, std::optional<double> b);

}  // namespace pleinair::measure
