// The contract against Aravis itself: a simulated GigE Vision camera that sends real packets over
// the loopback device.
#include <memory>
#include <string>

#include "hal/cameras/aravis/aravis_camera.h"
#include "tests/conformance/camera_conformance.h"
#include "tests/support/gige_simulator.h"

namespace pleinair::hal::conformance {
namespace {

[[maybe_unused]] const bool kHasPrivateNetwork = support::enterPrivateNetwork();

CameraCase loopbackCase(const std::string& name, const std::string& pixelFormat) {
  return {.name = name,
          .make = [pixelFormat, simulator = std::shared_ptr<support::GigeSimulator>()](
                      Clock& clock) mutable -> std::unique_ptr<Camera> {
            if (!simulator) simulator = std::make_shared<support::GigeSimulator>();
            EXPECT_TRUE(simulator->isRunning()) << "another program has UDP port 3956";
            return std::make_unique<aravis::AravisCamera>(
                "127.0.0.1",
                aravis::AravisOptions{.pixelFormat = pixelFormat, .binning = 8, .buffers = 12},
                aravis::systemLibrary(), clock);
          },
          .backend = "aravis",
          .isLive = true,
          .mayLosePackets = true};
}

INSTANTIATE_TEST_SUITE_P(AravisLoopback, CameraConformance,
                         testing::Values(loopbackCase("Mono8", "Mono8"),
                                         loopbackCase("BayerRg8", "BayerRG8"),
                                         loopbackCase("Rgb8", "RGB8")),
                         cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
