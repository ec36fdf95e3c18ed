// Requests of [camera] to a device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/config_error.h"
#include "firmware_app/config/configuration.h"
#include "firmware_app/config/configured_parts.h"

namespace pleinair::app {
namespace {

using std::chrono_literals::operator""us;

CameraSettings settingsWith(const std::vector<std::string>& set) {
  ConfigurationRequest request;
  request.set = set;
  request.defaultSiteFile.clear();
  return Configuration(request).camera();
}

std::string refusal(const std::string& set) {
  try {
    settingsWith({set});
  } catch (const config::ConfigError& error) {
    return error.what();
  }
  return {};
}

TEST(CameraControlSettings, LeaveTheDeviceAsItIsByDefault) {
  const hal::StreamRequest request = streamRequestOf(settingsWith({}));
  EXPECT_EQ(request.size, (hal::FrameSize{640, 480}));
  EXPECT_EQ(request.framePeriod, hal::Duration(33'333'333));
  EXPECT_EQ(request.pixelFormat, std::nullopt);
  EXPECT_EQ(request.controls, hal::CameraControls{});
}

TEST(CameraControlSettings, AskForAutomatics) {
  const hal::StreamRequest request =
      streamRequestOf(settingsWith({"camera.exposure=auto", "camera.gain=auto", "camera.focus=auto",
                                    "camera.white_balance=auto"}));
  EXPECT_EQ(request.controls, (hal::CameraControls{.exposure = hal::Automatic{},
                                                   .gain = hal::Automatic{},
                                                   .focus = hal::Automatic{},
                                                   .whiteBalance = hal::Automatic{}}));
}

TEST(CameraControlSettings, AskForValues) {
  const hal::StreamRequest request = streamRequestOf(
      settingsWith({"camera.size=1280x720", "camera.rate=50", "camera.exposure=8.5",
                    "camera.gain=0.25", "camera.focus=1", "camera.white_balance=5200"}));
  EXPECT_EQ(request.size, (hal::FrameSize{1280, 720}));
  EXPECT_EQ(request.framePeriod, hal::Duration(20'000us));
  EXPECT_EQ(
      request.controls,
      (hal::CameraControls{
          .exposure = hal::Duration(8500us), .gain = 0.25, .focus = 1.0, .whiteBalance = 5200.0}));
}

TEST(CameraControlSettings, RefuseWhatIsNoneOfThese) {
  EXPECT_EQ(refusal("camera.exposure=long"),
            "--set camera.exposure: found \"long\", allowed: auto, device, or a number of ms in "
            "(0, 10000]");
  EXPECT_THAT(refusal("camera.exposure=0"), testing::HasSubstr("found \"0\""));
  EXPECT_THAT(refusal("camera.exposure=5 ms"), testing::HasSubstr("found \"5 ms\""));
  EXPECT_THAT(refusal("camera.gain=1.1"), testing::HasSubstr("or a number in [0, 1]"));
  EXPECT_THAT(refusal("camera.focus=nan"), testing::HasSubstr("found \"nan\""));
  EXPECT_THAT(refusal("camera.white_balance=warm"),
              testing::HasSubstr("or a number of K in [1000, 20000]"));
}

}  // namespace
}  // namespace pleinair::app
