#include "hal/printable.h"

#include <algorithm>

namespace pleinair::hal {

std::string printable(std::string_view text) {
  std::string clean(text);
  std::ranges::replace_if(
      clean,
      [](char letter) {
        const auto byte = static_cast<unsigned char>(letter);
        return byte < 0x20 || byte == 0x7F;
      },
      '?');
  return clean;
}

}  // namespace pleinair::hal
