#include "hal/outputs/display/blanking.h"

#include <algorithm>
#include <charconv>

namespace pleinair::hal::display {
namespace {

std::optional<int> numberIn(std::string_view text, int most) {
  int number = 0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data(), end, number);
  if (read.ec != std::errc() || read.ptr != end || number < 0 || number > most) return std::nullopt;
  return number;
}

/// "08:00".
std::optional<Duration> timeIn(std::string_view text) {
  constexpr std::size_t kLength = 5;
  if (text.size() != kLength || text[2] != ':') return std::nullopt;
  const auto hours = numberIn(text.substr(0, 2), 23);
  const auto minutes = numberIn(text.substr(3), 59);
  if (!hours || !minutes) return std::nullopt;
  return std::chrono::hours(*hours) + std::chrono::minutes(*minutes);
}

}  // namespace

bool DailyTimes::contain(Duration timeOfDay) const {
  if (from < to) return timeOfDay >= from && timeOfDay < to;
  return timeOfDay >= from || timeOfDay < to;
}

std::optional<DailyTimes> DailyTimes::parsed(std::string_view text) {
  const std::size_t dash = text.find('-');
  if (dash == std::string_view::npos) return std::nullopt;
  const auto from = timeIn(text.substr(0, dash));
  const auto to = timeIn(text.substr(dash + 1));
  if (!from || !to || *from == *to) return std::nullopt;
  return DailyTimes{.from = *from, .to = *to};
}

bool BlankingRules::isOff(bool isInTimes, Duration quiet) const {
  if (after && quiet >= *after) return true;
  return times && isInTimes && quiet >= kQuiet;
}

std::optional<QuietTime> QuietTime::parsed(std::string_view text) {
  constexpr int kMaxSeconds = 86400;
  if (text == "never") return QuietTime{};
  const auto seconds = numberIn(text, kMaxSeconds);
  if (!seconds || *seconds == 0) return std::nullopt;
  return QuietTime{.after = std::chrono::seconds(*seconds)};
}

}  // namespace pleinair::hal::display
