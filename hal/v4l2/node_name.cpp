#include "hal/v4l2/node_name.h"

#include <charconv>
#include <system_error>

namespace pleinair::hal::v4l2 {

std::optional<int> videoNumber(std::string_view name) {
  constexpr std::string_view kPrefix = "video";
  if (!name.starts_with(kPrefix)) return std::nullopt;
  name.remove_prefix(kPrefix.size());
  int number = 0;
  const char* const last = name.data() + name.size();
  const auto [end, failure] = std::from_chars(name.data(), last, number);
  if (failure != std::errc() || end != last || number < 0) return std::nullopt;
  return number;
}

}  // namespace pleinair::hal::v4l2
