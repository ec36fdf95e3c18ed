#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "hal/cameras/libcamera/libcamera_camera.h"
#include "tests/conformance/camera_conformance.h"
#include "tests/support/fake_libcamera.h"

namespace pleinair::hal::conformance {
namespace {

/// A camera behind a library of its own.
CameraCase libcameraCase(const std::string& name, const support::FakeSensor& sensor) {
  // Frames outlive the camera, and the library outlives them: as long as the case.
  return {.name = name,
          .make = [sensor,
                   libraries =
                       std::make_shared<std::vector<std::unique_ptr<support::FakeLibcamera>>>()](
                      Clock& clock) -> std::unique_ptr<Camera> {
            support::FakeLibcamera& library =
                *libraries->emplace_back(std::make_unique<support::FakeLibcamera>(clock));
            library.plug(sensor);
            return std::make_unique<libcamera::LibcameraCamera>(
                sensor.id, libcamera::LibcameraOptions{}, library, clock);
          },
          .backend = "libcamera"};
}

support::FakeSensor withFormat(const char (&fourcc)[5], std::size_t padding = 0) {
  std::uint32_t code = 0;
  for (int i = 0; i < 4; ++i) code |= std::uint32_t{static_cast<std::uint8_t>(fourcc[i])} << 8 * i;
  return {.formats = {{.fourcc = code, .sizes = {{64, 48}}}}, .rowPadding = padding};
}

support::FakeSensor separate(support::FakeSensor sensor) {
  sensor.arePlanesSeparate = true;
  return sensor;
}

/// An image processor that makes two images of a frame.
support::FakeSensor withLuma(support::FakeSensor sensor, std::uint32_t fourcc) {
  sensor.luma = fourcc;
  return sensor;
}

/// vimc gives another size than it is asked for, and odd strides.
support::FakeSensor vimc() {
  support::FakeSensor sensor = withFormat("RG24");
  sensor.adjusts[{64, 48}] = {62, 48};
  return sensor;
}

INSTANTIATE_TEST_SUITE_P(
    Libcamera, CameraConformance,
    testing::Values(libcameraCase("Nv12", withFormat("NV12")),
                    libcameraCase("Nv12Padded", withFormat("NV12", 32)),
                    libcameraCase("Nv12Separate", separate(withFormat("NV12", 32))),
                    libcameraCase("I420Padded", withFormat("YU12", 32)),
                    libcameraCase("Yuyv", withFormat("YUYV")),
                    libcameraCase("Rgb", withFormat("BG24", 4)),
                    libcameraCase("BgrxPadded", withFormat("XR24", 8)),
                    libcameraCase("Nv12Luma", withLuma(withFormat("NV12"), 0x3231564E)),
                    libcameraCase("BgrxLuma", withLuma(withFormat("XR24", 8), 0x20203852)),
                    libcameraCase("Vimc", vimc())),
    cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
