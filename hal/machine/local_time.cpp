#include "hal/machine/local_time.h"

#include <ctime>

namespace pleinair::hal {

bool isPlausible(std::chrono::system_clock::time_point time) {
  using namespace std::chrono;
  return time >= sys_days(year(2026) / January / 1);
}

std::optional<Duration> localTimeOfDay() {
  const auto time = std::chrono::system_clock::now();
  if (!isPlausible(time)) return std::nullopt;
  const std::time_t now = std::chrono::system_clock::to_time_t(time);
  std::tm local{};
  ::localtime_r(&now, &local);
  return std::chrono::hours(local.tm_hour) + std::chrono::minutes(local.tm_min) +
         std::chrono::seconds(local.tm_sec);
}

}  // namespace pleinair::hal
