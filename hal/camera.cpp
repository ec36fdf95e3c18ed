#include "hal/camera.h"

namespace pleinair::hal {

std::string_view toString(FrameMemory memory) {
  switch (memory) {
    case FrameMemory::kProcessor:
      return "processor";
    case FrameMemory::kExported:
      return "exported";
    case FrameMemory::kLent:
      return "lent";
  }
  return "unknown";
}

}  // namespace pleinair::hal
