#include "hal/cameras/v4l2/controls.h"

#include <limits>

#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using testing::HasSubstr;

class V4l2Controls : public FakeCamera {
 protected:
  /// The controls of a UVC webcam.
  static std::vector<support::FakeControl> webcam() {
    return {{.id = V4L2_CID_EXPOSURE_AUTO,
             .max = 3,
             .value = 3,
             .menu = {V4L2_EXPOSURE_MANUAL, V4L2_EXPOSURE_APERTURE_PRIORITY}},
            {.id = V4L2_CID_EXPOSURE_ABSOLUTE, .min = 3, .max = 2047, .value = 250},
            {.id = V4L2_CID_GAIN, .min = 10, .max = 250, .value = 64},
            {.id = V4L2_CID_FOCUS_AUTO, .max = 1, .value = 1},
            {.id = V4L2_CID_FOCUS_ABSOLUTE, .max = 250, .step = 5, .value = 30},
            {.id = V4L2_CID_AUTO_WHITE_BALANCE, .max = 1, .value = 1},
            {.id = V4L2_CID_WHITE_BALANCE_TEMPERATURE, .min = 2000, .max = 6500, .value = 4000}};
  }
  void start(const CameraControls& controls) {
    plug({.controls = webcam()});
    startOrFail({.controls = controls});
  }
  std::string refusal(const CameraControls& controls) {
    const Error error = startError({.controls = controls});
    EXPECT_EQ(error.kind, ErrorKind::kUnsupported);
    return error.message();
  }
  int value(std::uint32_t id) const { return kernel_.controlValue(kNode, id); }
};

TEST_F(V4l2Controls, StayAsTheDeviceHasThemWhereUnset) {
  start({});
  for (const support::FakeControl& control : webcam()) EXPECT_EQ(value(control.id), control.value);
}

TEST_F(V4l2Controls, ThatAreSetSwitchTheDevicesLoopsOff) {
  start({.exposure = Duration(10ms), .gain = 0.5, .focus = 1.0, .whiteBalance = 5200.0});
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 100) << "in 100 µs";
  EXPECT_EQ(value(V4L2_CID_GAIN), 130);
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 0);
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 250);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 0);
  EXPECT_EQ(value(V4L2_CID_WHITE_BALANCE_TEMPERATURE), 5200);
}

TEST_F(V4l2Controls, ThatAreAutomaticSwitchThemOn) {
  start({.exposure = Duration(10ms), .focus = 0.3, .whiteBalance = 3000.0});
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 75);
  camera().stop();
  startOrFail(
      {.controls = {.exposure = Automatic{}, .focus = Automatic{}, .whiteBalance = Automatic{}}});
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_AUTO), V4L2_EXPOSURE_APERTURE_PRIORITY);
  EXPECT_EQ(value(V4L2_CID_FOCUS_AUTO), 1);
  EXPECT_EQ(value(V4L2_CID_AUTO_WHITE_BALANCE), 1);
}

TEST_F(V4l2Controls, AreClampedAndOnSteps) {
  start({.exposure = Duration(10s), .gain = -3.0, .focus = 0.49, .whiteBalance = 20'000.0});
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 2047);
  EXPECT_EQ(value(V4L2_CID_GAIN), 10);
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 125) << "122.5, in steps of 5";
  EXPECT_EQ(value(V4L2_CID_WHITE_BALANCE_TEMPERATURE), 6500);
}

TEST_F(V4l2Controls, OfAnEmptyRangeAreItsLeast) {
  plug({.controls = {{.id = V4L2_CID_GAIN, .min = 40, .max = 20}}});
  // Which no driver takes; the point is that it is an error of the device's, and no end of the
  // program.
  EXPECT_THAT(startError({.controls = {.gain = 0.5}}).message(), HasSubstr("cannot set its gain"));
}

TEST_F(V4l2Controls, OfNoNumberAreTheLeast) {
  start({.exposure = Duration(0), .gain = std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(value(V4L2_CID_EXPOSURE_ABSOLUTE), 3);
  EXPECT_EQ(value(V4L2_CID_GAIN), 10);
}

TEST_F(V4l2Controls, ThatAreMissingAreNamedWithThoseThatThereAre) {
  plug({.controls = {{.id = V4L2_CID_GAIN}, {.id = V4L2_CID_AUTO_WHITE_BALANCE, .max = 1}}});
  EXPECT_EQ(
      refusal({.focus = 0.5}),
      "/dev/video0: has no control of focus (Fake camera); remove the setting; the device has "
      "gain (no auto), white_balance (auto only)");
  EXPECT_THAT(refusal({.gain = Automatic{}}), HasSubstr("no control of automatic gain"));
  EXPECT_THAT(refusal({.whiteBalance = 5000.0}), HasSubstr("no control of white_balance"));
  startOrFail({.controls = {.gain = 0.5, .whiteBalance = Automatic{}}});
}

TEST_F(V4l2Controls, OfADeviceWithNoneSaySo) {
  plug();
  EXPECT_THAT(refusal({.exposure = Duration(1ms)}), HasSubstr("the device has no such controls"));
}

TEST_F(V4l2Controls, ThatCannotBeWrittenAreMissing) {
  plug({.controls = {{.id = V4L2_CID_GAIN, .flags = V4L2_CTRL_FLAG_READ_ONLY},
                     {.id = V4L2_CID_FOCUS_ABSOLUTE, .flags = V4L2_CTRL_FLAG_DISABLED}}});
  refusal({.gain = 0.5});
  refusal({.focus = 0.5});
}

TEST_F(V4l2Controls, FallBackToTheAnalogueGain) {
  plug({.controls = {{.id = V4L2_CID_ANALOGUE_GAIN, .max = 8}}});
  startOrFail({.controls = {.gain = 0.25}});
  EXPECT_EQ(value(V4L2_CID_ANALOGUE_GAIN), 2);
}

/// The mains' frequencies of a UVC webcam.
support::FakeControl powerLine(std::set<std::uint32_t> items) {
  return {.id = V4L2_CID_POWER_LINE_FREQUENCY,
          .max = static_cast<int>(*items.rbegin()),
          .value = V4L2_CID_POWER_LINE_FREQUENCY_60HZ,
          .menu = std::move(items)};
}

TEST_F(V4l2Controls, SetTheFrequencyOfTheMains) {
  plug({.controls = {powerLine({0, 1, 2})}});
  startOrFail();
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), V4L2_CID_POWER_LINE_FREQUENCY_60HZ) << "unset";
  destroyCamera();
  options.powerLine = PowerLine::k50Hz;
  EXPECT_EQ(startOrFail().warning, "");
  EXPECT_EQ(value(V4L2_CID_POWER_LINE_FREQUENCY), V4L2_CID_POWER_LINE_FREQUENCY_50HZ);
}

TEST_F(V4l2Controls, RefuseAFrequencyThatTheDeviceDoesNotOffer) {
  plug({.controls = {powerLine({0, 1, 2})}});
  options.powerLine = PowerLine::kAuto;
  EXPECT_EQ(refusal({}),
            "/dev/video0: has no power_line \"auto\" (Fake camera); set camera.v4l2.power_line to "
            "one of off, 50, 60");
  destroyCamera();
  plug();
  EXPECT_THAT(refusal({}),
              HasSubstr("remove camera.v4l2.power_line; the device has no such control"));
}

TEST_F(V4l2Controls, ThatReadBackOtherwiseAreTold) {
  auto controls = webcam();
  controls[1].kept = 250;  // the exposure
  controls[2].flags = V4L2_CTRL_FLAG_WRITE_ONLY;
  controls.push_back(powerLine({0, 1, 2}));
  controls.back().kept = V4L2_CID_POWER_LINE_FREQUENCY_60HZ;
  plug({.controls = std::move(controls)});
  options.powerLine = PowerLine::k50Hz;
  EXPECT_EQ(startOrFail({.controls = {.exposure = Duration(10ms), .gain = 0.5}}).warning,
            "keeps its power_line at 2 where 1 was set (0 to 2); keeps its exposure at 250 where "
            "100 was set (3 to 2047)");
}

TEST_F(V4l2Controls, OfWhichTheAutomaticStaysOnAreTold) {
  auto controls = webcam();
  controls[3].kept = 1;  // the automatic focus
  plug({.controls = std::move(controls)});
  EXPECT_EQ(startOrFail({.controls = {.focus = 0.3}}).warning,
            "keeps its automatic focus at 1 where 0 was set (0 to 1)");
  EXPECT_EQ(value(V4L2_CID_FOCUS_ABSOLUTE), 30) << "left as it was";
}

TEST_F(V4l2Controls, ThatTheDeviceRefusesAreAnError) {
  plug({.controls = webcam(), .failures = {{VIDIOC_S_CTRL, EBUSY}}});
  const Error error = startError({.controls = {.gain = 0.5}});
  EXPECT_EQ(error.kind, ErrorKind::kBusy);
  EXPECT_THAT(error.message(), HasSubstr("cannot set its gain"));
  expectNothingLeft();
}

}  // namespace
}  // namespace pleinair::hal::v4l2
