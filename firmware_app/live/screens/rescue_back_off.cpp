#include "firmware_app/live/screens/rescue_back_off.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>

#include <fmt/format.h>

namespace pleinair::app {
namespace {

struct Shown {
  hal::TimePoint until;
  hal::Duration time{};
};

std::optional<Shown> shownBefore(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::int64_t until = 0;
  std::int64_t time = 0;
  if (!(stream >> until >> time) || time <= 0) return std::nullopt;
  return Shown{.until = hal::TimePoint(std::chrono::nanoseconds(until)),
               .time = std::chrono::nanoseconds(time)};
}

}  // namespace

hal::Duration RescueBackOff::begin(hal::Duration shortest, hal::TimePoint now) const {
  hal::Duration time = shortest;
  const auto before = shownBefore(file_);
  // One that was itself restarted has the same time again.
  if (before && now < before->until) time = before->time;
  if (before && now >= before->until && now - before->until < kRecovered) time = 2 * before->time;
  time = std::min(time, std::max(kLongest, shortest));
  std::ofstream(file_) << fmt::format("{} {}\n", (now + time).time_since_epoch().count(),
                                      time.count());
  return time;
}

}  // namespace pleinair::app
