#include "hal/outputs/window/window.h"

#include <cstdlib>

#include "tests/conformance/output_conformance.h"
#include "tests/support/x_server.h"

namespace pleinair::hal::conformance {
namespace {

/// SDL's driver without a display.
OutputCase dummy() {
  return {.name = "Dummy",
          .make =
              [](const auto&) {
                setenv("SDL_VIDEODRIVER", "dummy", 1);
                return orThrow(openWindow());
              },
          .backend = "window",
          .file = ""};
}

/// On an X server of its own, which lives as long as the case does.
OutputCase x11() {
  return {.name = "X11",
          .make =
              [server = std::shared_ptr<support::XServer>()](const auto&) mutable {
                if (!server) server = std::make_shared<support::XServer>();
                unsetenv("SDL_VIDEODRIVER");
                unsetenv("WAYLAND_DISPLAY");
                setenv("DISPLAY", server->display().c_str(), 1);
                return orThrow(openWindow());
              },
          .backend = "window",
          .file = "",
          .missing = support::XServer::missing()};
}

INSTANTIATE_TEST_SUITE_P(Window, OutputConformance, testing::Values(dummy(), x11()),
                         outputCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
