// In place of the window where the build found no SDL.
#include "hal/outputs/window/window.h"

namespace pleinair::hal {

Result<std::unique_ptr<Window>> openWindow(WindowSettings /*settings*/) {
  return tl::unexpected(
      Error{.kind = ErrorKind::kUnsupported,
            .subject = "window",
            .problem = "this build has none",
            .remedy = "install libsdl2-dev and libpango1.0-dev and build again, or write to a "
                      "file with --output FILE"});
}

}  // namespace pleinair::hal
