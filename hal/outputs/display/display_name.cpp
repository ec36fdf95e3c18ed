#include "hal/outputs/display/display_name.h"

#include <algorithm>

namespace pleinair::hal::display {

bool isDisplayName(const std::string& name) {
  if (name == kDisplayName) return true;
  return name.starts_with("display:") && name.size() > kDisplayName.size() + 1 &&
         name.find('/') == std::string::npos;
}

DisplayName parseDisplayName(const std::string& name) {
  if (name == kDisplayName) return {};
  const std::string rest = name.substr(kDisplayName.size() + 1);
  const std::size_t dash = rest.find('-');
  const bool hasCard = rest.starts_with("card") && dash != std::string::npos && dash > 4 &&
                       std::all_of(rest.begin() + 4, rest.begin() + static_cast<long>(dash),
                                   [](char c) { return c >= '0' && c <= '9'; });
  if (!hasCard) return {.card = {}, .connector = rest};
  return {.card = rest.substr(0, dash), .connector = rest.substr(dash + 1)};
}

}  // namespace pleinair::hal::display
