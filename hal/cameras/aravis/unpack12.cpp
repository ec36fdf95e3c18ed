#include "hal/cameras/aravis/unpack12.h"

#include <cassert>

namespace pleinair::hal::aravis {

void unpack12p(std::span<const std::uint8_t> packed, std::span<std::uint8_t> samples) {
  assert(2 * packed.size() >= 3 * samples.size());
  const std::uint8_t* from = packed.data();
  const std::size_t pairs = samples.size() / 2;
  std::uint8_t* to = samples.data();
  for (std::size_t i = 0; i < pairs; ++i, from += 3, to += 2) {
    to[0] = static_cast<std::uint8_t>((from[1] & 0x0F) << 4 | from[0] >> 4);
    to[1] = from[2];
  }
  if (samples.size() % 2 != 0) {
    to[0] = static_cast<std::uint8_t>((from[1] & 0x0F) << 4 | from[0] >> 4);
  }
}

void unpack12Packed(std::span<const std::uint8_t> packed, std::span<std::uint8_t> samples) {
  assert(2 * packed.size() >= 3 * samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = packed[i / 2 * 3 + (i % 2 != 0 ? 2 : 0)];
  }
}

}  // namespace pleinair::hal::aravis
