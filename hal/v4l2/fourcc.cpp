#include "hal/v4l2/fourcc.h"

namespace pleinair::hal::v4l2 {

std::string fourccText(std::uint32_t fourcc) {
  constexpr std::uint32_t kBigEndian = 1u << 31;
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (int shift = 0; shift < 32; shift += 8) {
    const std::uint32_t byte = (fourcc & ~kBigEndian) >> shift & 0xFF;
    if (byte >= ' ' && byte <= '~') {
      text += static_cast<char>(byte);
    } else {
      text += {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 0xF]};
    }
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return (fourcc & kBigEndian) != 0 ? text + "-BE" : text;
}

}  // namespace pleinair::hal::v4l2
