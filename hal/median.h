#pragma once

#include <algorithm>
#include <iterator>
#include <ranges>

namespace pleinair::hal {

/// The median; of an even number, the upper of the two in the middle. Reorders the values.
/// Precondition: there are some.
template <std::ranges::random_access_range Values>
std::ranges::range_value_t<Values> medianOf(Values&& values) {
  const auto middle = std::ranges::begin(values) + std::ranges::distance(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace pleinair::hal
