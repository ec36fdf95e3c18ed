#include "hal/frame_image.h"

#include <atomic>

namespace pleinair::hal {

std::uint64_t nextBufferPool() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

Image::Image(const FrameImage& picture) : Image(picture.map().view()) {}

}  // namespace pleinair::hal
