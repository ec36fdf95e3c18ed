#include "pipeline/measure/mean.h"

namespace pleinair::measure {

std::optional<double> ratio(std::optional<double> a, std::optional<double> b) {
  if (!a || !b || *b == 0) return std::nullopt;
  return *a / *b;
}

}  // namespace pleinair::measure
