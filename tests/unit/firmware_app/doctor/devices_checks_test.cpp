#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/firmware_app/doctor/healthy_machine.h"

namespace pleinair::app::doctor {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(CheckCameras, NamesThose) {
  HealthyMachine machine;
  const Finding finding = checkCameras(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "/dev/video0 (C920)");
}

TEST(CheckCameras, WarnsOfNone) {
  HealthyMachine machine;
  machine.cameras.cameras.clear();
  const Finding finding = checkCameras(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("lsusb"));
}

TEST(CheckCameras, WarnsOfFormatsThatAreNotRead) {
  HealthyMachine machine;
  machine.cameras.cameras[0].modes[0].isSupported = false;
  const Finding finding = checkCameras(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("pleinair devices"));
}

TEST(CheckCameras, AsksForTheGroupThoughAnotherWorks) {
  HealthyMachine machine;
  hal::CameraDescription other = machine.cameras.cameras[0];
  other.node = "/dev/video2";
  other.problem = errorOf(hal::ErrorKind::kPermissionDenied, "cannot open: Permission denied");
  machine.cameras.cameras.push_back(other);
  const Finding finding = checkCameras(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_THAT(finding.text, HasSubstr("/dev/video2 (C920): cannot open"));
  EXPECT_THAT(finding.remedy, HasSubstr("usermod -aG video"));
}

TEST(CheckCameras, TellsWhoUsesABusyOne) {
  HealthyMachine machine;
  machine.cameras.cameras[0].problem = errorOf(hal::ErrorKind::kBusy, "is in use");
  const Finding finding = checkCameras(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("fuser -v /dev/video0"));
}

TEST(CheckCameras, IsWrongWhereTheyCannotBeListed) {
  HealthyMachine machine;
  machine.cameras.problems = {errorOf(hal::ErrorKind::kIo, "cannot read /dev")};
  EXPECT_EQ(checkCameras(machine.probes()).verdict, Verdict::kWrong);
}

TEST(CheckUsbCameras, WarnsWithoutTheModule) {
  HealthyMachine machine;
  EXPECT_EQ(checkUsbCameras(machine.probes()).verdict, Verdict::kOk);
  machine.folders.erase("/sys/module/uvcvideo");
  const Finding finding = checkUsbCameras(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_EQ(finding.remedy, "sudo modprobe uvcvideo");
}

TEST(CheckLoopback, NamesTheDevice) {
  HealthyMachine machine;
  Finding finding = checkLoopback(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "/dev/video50 (pleinair)");
  EXPECT_THAT(finding.remedy, IsEmpty());
  machine.loopbacks[0].isWritable = false;
  finding = checkLoopback(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_THAT(finding.text, HasSubstr("another program writes to it now"));
}

TEST(CheckLoopback, TellsNotLoadedFromNotInstalled) {
  HealthyMachine machine;
  machine.folders.erase("/sys/module/v4l2loopback");
  Finding finding = checkLoopback(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("not installed"));
  EXPECT_THAT(finding.remedy, HasSubstr("apt install v4l2loopback-dkms"));
  machine.folders["/lib/modules/6.1.0-28-amd64/updates/dkms"] = {
      "/lib/modules/6.1.0-28-amd64/updates/dkms/v4l2loopback.ko.xz"};
  finding = checkLoopback(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("not loaded"));
  EXPECT_EQ(finding.remedy, hal::kLoadLoopback);
}

TEST(CheckLoopback, WarnsWithoutExclusiveCapabilities) {
  HealthyMachine machine;
  machine.files["/sys/module/v4l2loopback/parameters/exclusive_caps"] = "N,N,N,N,N,N,N,N";
  const Finding finding = checkLoopback(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("browsers"));
  EXPECT_THAT(finding.remedy, HasSubstr("modprobe -r v4l2loopback && "));
}

TEST(CheckLoopback, WarnsWithoutADevice) {
  HealthyMachine machine;
  machine.loopbacks.clear();
  EXPECT_EQ(checkLoopback(machine.probes()).verdict, Verdict::kWarning);
}

TEST(CheckLoopback, AsksForTheGroup) {
  HealthyMachine machine;
  machine.loopbacks = {
      {.node = "/dev/video50",
       .problem = errorOf(hal::ErrorKind::kPermissionDenied, "cannot open: Permission denied")}};
  const Finding finding = checkLoopback(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_THAT(finding.remedy, HasSubstr("usermod -aG video"));
}

TEST(CheckKeyboards, NamesTheFirst) {
  HealthyMachine machine;
  const Finding finding = checkKeyboards(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "/dev/input/event2 (AT keyboard)");
}

TEST(CheckKeyboards, AsksForTheGroup) {
  HealthyMachine machine;
  machine.keyboards.front().problem =
      errorOf(hal::ErrorKind::kPermissionDenied, "cannot open: Permission denied");
  const Finding finding = checkKeyboards(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.remedy, HasSubstr("usermod -aG input"));
}

TEST(CheckKeyboards, APowerButtonThatIsRefusedIsNoKeyboard) {
  HealthyMachine machine;
  machine.keyboards.front().description.isKeyboard = false;
  machine.keyboards.front().problem = errorOf(hal::ErrorKind::kPermissionDenied, "cannot open");
  EXPECT_EQ(checkKeyboards(machine.probes()).verdict, Verdict::kOk);
}

TEST(CheckDisplays, NamesTheFirstThatIsPluggedIn) {
  HealthyMachine machine;
  const Finding finding = checkDisplays(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text,
            "display:card0-HDMI-A-1, 1920x1080; the GPU draws straight into its memory, "
            "rows (linear) (trial: 120 ms)");
}

TEST(CheckDisplays, SaysWhyPicturesAreCopied) {
  HealthyMachine machine;
  machine.scanOut = {.isDirect = false,
                     .reason = "GPU: shares no memory with displays",
                     .took = std::chrono::milliseconds(3)};
  const Finding finding = checkDisplays(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_THAT(finding.text, HasSubstr("pictures are copied: GPU: shares no memory"));
}

TEST(CheckDisplays, WarnsWithoutADisplay) {
  HealthyMachine machine;
  machine.displays.outputs.front().problem =
      errorOf(hal::ErrorKind::kDeviceLost, "no display is plugged in");
  EXPECT_THAT(checkDisplays(machine.probes()).text, HasSubstr("none of 1 connectors"));
  machine.displays.outputs.clear();
  EXPECT_THAT(checkDisplays(machine.probes()).text, HasSubstr("no graphics card"));
}

TEST(CheckDisplays, SaysWhoHasTheDisplay) {
  HealthyMachine machine;
  machine.displayProblem = hal::Error{.kind = hal::ErrorKind::kBusy,
                                      .problem = "another program shows pictures there: Xorg (712)",
                                      .remedy = "end it"};
  const Finding finding = checkDisplays(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("Xorg (712)"));
  EXPECT_EQ(finding.remedy, "end it");
}

TEST(CheckDisplays, AsksForTheGroup) {
  HealthyMachine machine;
  machine.displayProblem = errorOf(hal::ErrorKind::kPermissionDenied, "cannot open");
  const Finding finding = checkDisplays(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWrong);
  EXPECT_THAT(finding.remedy, HasSubstr("usermod -aG video"));
}

TEST(CheckDisplayTiming, TellsTheModeThatWouldBeSet) {
  HealthyMachine machine;
  const Finding finding = checkDisplayTiming(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kOk);
  EXPECT_EQ(finding.text, "1920x1080 at 59.94 Hz, of which each refresh is counted");
}

TEST(CheckDisplayTiming, WarnsOfADriverWithoutVerticalBlanking) {
  HealthyMachine machine;
  machine.displayTiming->hasVblank = false;
  const Finding finding = checkDisplayTiming(machine.probes());
  EXPECT_EQ(finding.verdict, Verdict::kWarning);
  EXPECT_THAT(finding.text, HasSubstr("no vertical blanking"));
  EXPECT_FALSE(finding.remedy.empty());
}

TEST(CheckDisplayTiming, WarnsOfADisplayThatCannotBeShownOnButNotOfNone) {
  HealthyMachine machine;
  machine.displayTiming = tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                                    .problem = "no plane takes XRGB8888",
                                                    .remedy = "another card"});
  EXPECT_EQ(checkDisplayTiming(machine.probes()).verdict, Verdict::kWarning);
  EXPECT_EQ(checkDisplayTiming(machine.probes()).remedy, "another card");
  machine.displayTiming =
      tl::unexpected(errorOf(hal::ErrorKind::kDeviceLost, "no display is plugged in"));
  EXPECT_EQ(checkDisplayTiming(machine.probes()).verdict, Verdict::kOk);
}

}  // namespace
}  // namespace pleinair::app::doctor
