#pragma once

#include <libcamera/libcamera.h>

// What the files that call libcamera share: only lc_*.cpp and libcamera_library.cpp include this.

/// 0.3.2 as 302: what interfaces are checked by.
#define PLEINAIR_LIBCAMERA_VERSION \
  (LIBCAMERA_VERSION_MAJOR * 10000 + LIBCAMERA_VERSION_MINOR * 100 + LIBCAMERA_VERSION_PATCH)

namespace pleinair::hal::libcamera {

namespace lc = ::libcamera;

}  // namespace pleinair::hal::libcamera
