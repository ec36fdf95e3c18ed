#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace pleinair::tracking {

/// Reorders the values. Precondition: there are some.
inline double medianOf(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace pleinair::tracking
