#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/cameras/libcamera/libcamera_kind.h"
#include "hal/supervisor/camera_selector.h"
#include "tests/support/fake_libcamera.h"

namespace pleinair::hal::libcamera {
namespace {

TEST(LibcameraListing, LeavesUsbCamerasToV4l2) {
  SteppedClock clock;
  support::FakeLibcamera library(clock);
  library.plug({.id = "\\_SB_.PCI0-2.1:1.0-046d:0825", .model = "C270", .isUsb = true});
  library.plug({.id = "/base/i2c/imx708@1a", .model = "imx708"});
  LibcameraBackend backend({}, library);
  const auto cameras = backend.list();
  ASSERT_EQ(cameras->size(), 1u);
  EXPECT_EQ(cameras->front().identity.id, "/base/i2c/imx708@1a");
  EXPECT_EQ(cameras->front().identity.description, "imx708");
  EXPECT_FALSE(cameras->front().areModesKnown);
}

TEST(LibcameraListing, IsOpenedByIdAndByAuto) {
  SteppedClock clock;
  support::FakeLibcamera library(clock);
  library.plug({.id = "/base/i2c/imx219@10", .isBusy = true});
  library.plug({.id = "/base/i2c/imx708@1a"});
  const auto backend = std::make_shared<LibcameraBackend>(LibcameraOptions{}, library);
  for (const std::string choice : {"auto", "libcamera", "libcamera:/base/i2c/imx708@1a"}) {
    CameraSelector selector({{.backend = backend}}, choice, clock);
    const auto opened = selector.open({});
    ASSERT_TRUE(opened) << choice << ": " << opened.error().message();
    EXPECT_EQ(opened->camera->identity().id, "/base/i2c/imx708@1a") << choice;
  }
}

TEST(LibcameraListing, OfTheSystemAnswers) {
  // Whatever cameras there are: it must start and stop, again and again.
  for (int i = 0; i < 3; ++i) {
    const auto cameras = LibcameraBackend().list();
    EXPECT_TRUE(cameras) << cameras.error().message();
  }
  SteppedClock clock;
  const auto camera = LibcameraBackend().make("no-such-camera", clock);
  const auto format = camera->start({});
  ASSERT_FALSE(format);
  EXPECT_THAT(format.error().message(), testing::StartsWith("libcamera:no-such-camera: "));
}

}  // namespace
}  // namespace pleinair::hal::libcamera
