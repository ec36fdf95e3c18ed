#include "hal/supervisor/back_off.h"

#include <algorithm>
#include <cmath>

namespace pleinair::hal {

Duration BackOff::grow() {
  const Duration wait = std::min(next_, rule_.maximum);
  const double grown = static_cast<double>(wait.count()) * rule_.factor;
  const double most = static_cast<double>(rule_.maximum.count());
  next_ = grown < most ? Duration(std::llround(grown)) : rule_.maximum;
  return wait;
}

void BackOff::streamed(Duration duration) {
  if (duration >= rule_.resetAfter) reset();
}

}  // namespace pleinair::hal
