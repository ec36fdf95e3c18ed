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

TEST(LibcameraListing, TellsModesAndTheOneThatIsTaken) {
  SteppedClock clock;
  support::FakeLibcamera library(clock);
  support::FakeSensor sensor;
  sensor.formats = {{.fourcc = 0x34324752, .sizes = {{320, 180}}},               // RGB888
                    {.fourcc = 0x30314742, .sizes = {{320, 180}, {640, 360}}},   // raw Bayer
                    {.fourcc = 0x3231564E, .sizes = {{320, 180}, {640, 360}}}};  // NV12
  sensor.adjusts[{320, 180}] = {318, 180};
  sensor.periods = std::array<Duration, 2>{Duration(20'000'000), Duration(100'000'000)};
  library.plug(sensor);
  LibcameraBackend backend({}, library);
  const auto modes = backend.offeredModes(
      sensor.id, {.size = FrameSize{320, 180}, .framePeriod = Duration(10'000'000)});
  ASSERT_TRUE(modes) << modes.error().message();
  ASSERT_EQ(modes->modes.size(), 5u);
  EXPECT_EQ(modes->modes[1].layout, "BG10");
  EXPECT_FALSE(modes->modes[1].isSupported);
  EXPECT_EQ(modes->chosen.mode.layout, "NV12");
  EXPECT_EQ(modes->chosen.mode.size, (FrameSize{318, 180}));
  EXPECT_THAT(modes->chosen.mode.periods, testing::ElementsAre(Duration(20'000'000)));
  EXPECT_EQ(
      modes->chosen.reason,
      "the cheapest to paint of the formats that are read as they are; libcamera gives 318x180 "
      "px for 320x180");
  EXPECT_EQ(library.told.open, 0) << "it is closed";
  EXPECT_EQ(backend.offeredModes("imx000", {}).error().message(), "libcamera:imx000: is not there");
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
