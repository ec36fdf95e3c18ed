#include "hal/outputs/window/window.h"

#include "tests/conformance/output_conformance.h"
#include "tests/support/environment.h"
#include "tests/support/x_server.h"

namespace pleinair::hal::conformance {
namespace {

/// SDL's driver without a display.
OutputCase dummy() {
  return {.name = "Dummy",
          .make =
              [](const auto&) {
                support::setVariable("SDL_VIDEODRIVER", "dummy");
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
                support::setVariable("SDL_VIDEODRIVER", nullptr);
                support::setVariable("WAYLAND_DISPLAY", nullptr);
                support::setVariable("DISPLAY", server->display().c_str());
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
