#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/cameras/aravis/aravis_camera.h"
#include "tests/conformance/camera_conformance.h"
#include "tests/support/fake_aravis.h"

namespace pleinair::hal::conformance {
namespace {

/// A camera behind a library of its own.
CameraCase aravisCase(const std::string& name, const support::FakeGigeCamera& fake,
                      aravis::AravisOptions options = {}) {
  // Frames outlive the camera, and the library outlives them: as long as the case.
  return {
      .name = name,
      .make = [fake, options,
               libraries = std::make_shared<std::vector<std::unique_ptr<support::FakeAravis>>>()](
                  Clock& clock) -> std::unique_ptr<Camera> {
        support::FakeAravis& library =
            *libraries->emplace_back(std::make_unique<support::FakeAravis>(clock));
        library.plug(fake);
        return std::make_unique<aravis::AravisCamera>(fake.id, options, library, clock);
      },
      .backend = "aravis"};
}

support::FakeGigeCamera withFormat(std::uint32_t pfnc, std::size_t padding = 0) {
  return {.formats = {pfnc}, .padding = padding};
}

support::FakeGigeCamera usb() {
  support::FakeGigeCamera camera = withFormat(0x01080009);
  camera.transport = aravis::Transport::kUsb3;
  camera.firstId = 1'000'000;
  camera.chunkBytes = 24;
  return camera;
}

INSTANTIATE_TEST_SUITE_P(Aravis, CameraConformance,
                         testing::Values(aravisCase("Mono8", withFormat(0x01080001)),
                                         aravisCase("Rgb8Padded", withFormat(0x02180014, 4)),
                                         aravisCase("BayerBg8", withFormat(0x0108000B)),
                                         aravisCase("Yuv422", withFormat(0x02100032)),
                                         aravisCase("Mono12p", withFormat(0x010C0047)),
                                         aravisCase("BayerRg12pPadded", withFormat(0x010C0059, 2)),
                                         aravisCase("Usb3WithChunks", usb()),
                                         aravisCase("SoftwareTrigger", withFormat(0x01080001),
                                                    {.trigger = "software"})),
                         cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
