#include "hal/cameras/libcamera/settings.h"

#include <chrono>

#include <gmock/gmock.h>

#include "tests/unit/hal/libcamera/fake_sensor_test.h"

namespace pleinair::hal::libcamera {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class LibcameraSettingsTest : public FakeSensorTest {
 protected:
  LibcameraSettingsTest() {
    sensor.ranges = {
        {Control::kExposure, {100, 60'000}}, {Control::kGain, {1, 17}}, {Control::kFocus, {0, 10}}};
    sensor.automatic = {Control::kExposure, Control::kGain, Control::kWhiteBalance};
    sensor.periods = std::array<Duration, 2>{Duration(10ms), Duration(100ms)};
  }
  std::optional<AutomaticOr<double>> told(Control control) const {
    return library_.told.settings.controls.at(static_cast<std::size_t>(control));
  }
};

TEST_F(LibcameraSettingsTest, ConvertsToTheCamerasUnits) {
  ASSERT_TRUE(start(
      {.framePeriod = 33ms, .controls = {.exposure = Duration(8ms), .gain = 0.25, .focus = 0.5}}));
  EXPECT_EQ(told(Control::kExposure), (AutomaticOr<double>(8000.0))) << "microseconds";
  EXPECT_EQ(told(Control::kGain), (AutomaticOr<double>(5.0)));
  EXPECT_EQ(told(Control::kFocus), (AutomaticOr<double>(5.0))) << "dioptres";
  EXPECT_FALSE(told(Control::kWhiteBalance)) << "left as it is";
  EXPECT_EQ(library_.told.settings.framePeriod, Duration(33ms));
}

TEST_F(LibcameraSettingsTest, ClampsToTheCamerasRanges) {
  const auto format =
      start({.framePeriod = 5ms, .controls = {.exposure = Duration(1s), .gain = 7.0}});
  ASSERT_TRUE(format);
  EXPECT_EQ(told(Control::kExposure), (AutomaticOr<double>(60'000.0)));
  EXPECT_EQ(told(Control::kGain), (AutomaticOr<double>(17.0)));
  EXPECT_EQ(format->framePeriod, Duration(10ms)) << "the shortest that it can have";
  sensor.periods.reset();
  EXPECT_FALSE(start({.framePeriod = 5ms})->framePeriod) << "it does not say";
}

TEST_F(LibcameraSettingsTest, SwitchesAutomaticControlsOn) {
  ASSERT_TRUE(start({.controls = {.exposure = Automatic{}, .whiteBalance = Automatic{}}}));
  EXPECT_EQ(told(Control::kExposure), (AutomaticOr<double>(Automatic{})));
  EXPECT_EQ(told(Control::kWhiteBalance), (AutomaticOr<double>(Automatic{})));
}

TEST_F(LibcameraSettingsTest, SaysWhichControlsThereAre) {
  EXPECT_EQ(failure({.controls = {.whiteBalance = 5000.0}}),
            "libcamera:/base/i2c/imx708@1a: has no control of white_balance; remove the setting; "
            "the device has exposure, gain, focus (no auto), white_balance (auto only)");
  EXPECT_THAT(failure({.controls = {.focus = Automatic{}}}),
              HasSubstr("has no control of automatic focus"));
  sensor.ranges.clear();
  sensor.automatic.clear();
  EXPECT_THAT(failure({.controls = {.gain = 0.5}}), HasSubstr("the device has no such controls"));
}

}  // namespace
}  // namespace pleinair::hal::libcamera
