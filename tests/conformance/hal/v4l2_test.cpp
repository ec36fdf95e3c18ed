#include <linux/videodev2.h>

#include "hal/cameras/v4l2/v4l2_camera.h"
#include "tests/conformance/camera_conformance.h"
#include "tests/support/fake_v4l2.h"
#include "tests/support/test_jpegs.h"

namespace pleinair::hal::conformance {
namespace {

/// A camera on a device of its own, behind a system of its own.
CameraCase v4l2Case(const std::string& name, const support::FakeVideo& video) {
  struct World {
    explicit World(Clock& clock) : calls(clock) {}
    support::FakeV4l2 calls;
    support::FakeNodes nodes;
  };
  // Frames outlive the camera, and the system outlives them: as long as the case.
  return {.name = name,
          .make = [video, worlds = std::make_shared<std::vector<std::unique_ptr<World>>>()](
                      Clock& clock) -> std::unique_ptr<Camera> {
            World& world = *worlds->emplace_back(std::make_unique<World>(clock));
            world.calls.plug(video);
            return std::make_unique<v4l2::V4l2Camera>(
                video.node, v4l2::System{.calls = world.calls, .nodes = world.nodes}, clock);
          },
          .backend = "v4l2"};
}

support::FakeVideo withFormat(std::uint32_t fourcc, std::size_t padding = 0,
                              std::uint32_t caps = V4L2_CAP_VIDEO_CAPTURE) {
  return {
      .caps = caps | V4L2_CAP_STREAMING, .formats = {{.fourcc = fourcc}}, .rowPadding = padding};
}

support::FakeVideo jpegCamera() {
  support::FakeVideo video = withFormat(V4L2_PIX_FMT_MJPEG);
  video.formats[0].sizes = {support::kTestJpegSize};
  video.jpeg = support::testJpeg("j422.jpg");
  return video;
}

support::FakeVideo loopback() {
  support::FakeVideo video = withFormat(V4L2_PIX_FMT_YUYV);
  video.mostBuffers = 2;
  video.exportsDmaBufs = false;
  video.firstSequence = 0xFFFFFFFE;  // it counts on from its last reader, and wraps
  return video;
}

INSTANTIATE_TEST_SUITE_P(
    V4l2, CameraConformance,
    testing::Values(v4l2Case("Yuyv", withFormat(V4L2_PIX_FMT_YUYV)),
                    v4l2Case("Nv12Padded", withFormat(V4L2_PIX_FMT_NV12, 32)),
                    v4l2Case("I420Padded", withFormat(V4L2_PIX_FMT_YUV420, 32)),
                    v4l2Case("Rgb", withFormat(V4L2_PIX_FMT_RGB24, 4)),
                    v4l2Case("Grey", withFormat(V4L2_PIX_FMT_GREY)),
                    v4l2Case("Bayer", withFormat(V4L2_PIX_FMT_SBGGR8, 16)),
                    v4l2Case("MultiPlanarNv12",
                             withFormat(V4L2_PIX_FMT_NV12M, 8, V4L2_CAP_VIDEO_CAPTURE_MPLANE)),
                    v4l2Case("MultiPlanarYuyv",
                             withFormat(V4L2_PIX_FMT_YUYV, 8, V4L2_CAP_VIDEO_CAPTURE_MPLANE)),
                    v4l2Case("Jpeg", jpegCamera()), v4l2Case("Loopback", loopback())),
    cameraCaseName);

}  // namespace
}  // namespace pleinair::hal::conformance
