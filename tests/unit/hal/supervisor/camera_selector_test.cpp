#include "hal/supervisor/camera_selector.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/scripted_camera.h"

namespace pleinair::hal {
namespace {

using support::ScriptedBackend;
using support::scriptedError;
using support::ScriptedSession;
using testing::HasSubstr;

/// Two back ends of devices, and one that has no devices.
class CameraSelectorTest : public testing::Test {
 protected:
  CameraSelector selector(std::string choice) {
    return CameraSelector({{.backend = csi_, .isDevice = true},
                           {.backend = usb_, .isDevice = true},
                           {.backend = files_, .isDevice = false}},
                          std::move(choice), clock_);
  }
  /// "BACKEND:ID" of the opened camera, or the error.
  std::string opened(const std::string& choice) {
    CameraSelector chosen = selector(choice);
    return told(chosen.open({}));
  }
  static std::string told(const Result<OpenedCamera>& camera) {
    if (!camera) return camera.error().message();
    const CameraIdentity identity = camera->camera->identity();
    return identity.backend + ":" + identity.id;
  }

  SteppedClock clock_;
  std::shared_ptr<ScriptedBackend> csi_ = std::make_shared<ScriptedBackend>("csi", clock_);
  std::shared_ptr<ScriptedBackend> usb_ = std::make_shared<ScriptedBackend>("usb", clock_);
  std::shared_ptr<ScriptedBackend> files_ = std::make_shared<ScriptedBackend>("files", clock_);
  const ScriptedSession sound_{.steps = {}};
  const ScriptedSession busy_{.startError = scriptedError(ErrorKind::kBusy, "is in use"),
                              .steps = {}};
};

TEST_F(CameraSelectorTest, ByIdNodeAndSerial) {
  usb_->add("046d:0825", {sound_}, "/dev/video0", "ABC");
  usb_->add("046d:9999", {sound_}, "/dev/video2", "DEF");
  EXPECT_EQ(opened("usb:046d:9999"), "usb:046d:9999");
  EXPECT_EQ(opened("usb:/dev/video0"), "usb:046d:0825");
  usb_->add("x", {sound_}, "/dev/video4", "XYZ");
  EXPECT_EQ(opened("serial:XYZ"), "usb:x");
}

TEST_F(CameraSelectorTest, AutoAsksABackEndOnlyWhenThoseBeforeItHaveFailed) {
  const auto first = csi_->add("sensor", {sound_, busy_}, "/dev/video0");
  usb_->add("webcam", {sound_}, "/dev/video1");
  CameraSelector chosen = selector("auto");
  EXPECT_EQ(told(chosen.open({})), "csi:sensor");
  EXPECT_EQ(usb_->lists, 0) << "asking may take a second";
  EXPECT_EQ(told(chosen.open({})), "usb:webcam");
  EXPECT_EQ(usb_->lists, 1);
}

TEST_F(CameraSelectorTest, LooksAgainWhereDevicesComeWhileItLooks) {
  CameraSelector chosen = selector("auto");
  csi_->whenListed = [&] {
    if (csi_->lists != 1) return;
    csi_->add("sensor", {sound_}, "/dev/video0");  // too late for this listing
    chosen.devicesChanged();
  };
  EXPECT_EQ(told(chosen.open({})), "csi:sensor");
  EXPECT_EQ(csi_->lists, 2);
  EXPECT_EQ(usb_->lists, 0) << "asking may take a second";
}

TEST_F(CameraSelectorTest, GivesUpOnDevicesThatComeAndGoForEver) {
  usb_->add("webcam", {sound_}, "/dev/video1");
  CameraSelector chosen = selector("auto");
  csi_->whenListed = [&] { chosen.devicesChanged(); };
  EXPECT_EQ(told(chosen.open({})), "usb:webcam");
  EXPECT_EQ(csi_->lists, 4);
}

TEST_F(CameraSelectorTest, StopsLookingWhenItIsInterrupted) {
  usb_->add("webcam", {sound_}, "/dev/video1");
  CameraSelector chosen = selector("auto");
  csi_->whenListed = [&] {
    chosen.devicesChanged();
    chosen.interrupt();
  };
  EXPECT_FALSE(chosen.open({}));
  EXPECT_EQ(csi_->lists, 1) << "a listing may take seconds";
  EXPECT_EQ(usb_->lists, 0);
}

TEST_F(CameraSelectorTest, FollowsACameraToTheNodeThatItGotAfterAReset) {
  const auto device = usb_->add("046d:0825", {sound_}, "/dev/video0");
  const auto other = usb_->add("046d:9999", {sound_}, "/dev/video2");
  device->repeatsLast = other->repeatsLast = true;
  device->description.path = "usb-0:1";
  other->description.path = "usb-0:2";
  CameraSelector chosen = selector("usb:/dev/video0");
  EXPECT_EQ(told(chosen.open({})), "usb:046d:0825");
  device->description.node = "/dev/video1";
  EXPECT_EQ(told(chosen.open({})), "usb:046d:0825") << "the node is gone, the camera is not";
  other->description.node = "/dev/video0";
  EXPECT_EQ(told(chosen.open({})), "usb:046d:9999") << "the node in the choice comes first";
  other->description.node = "/dev/video2";
  EXPECT_EQ(told(chosen.open({})), "usb:046d:9999") << "the last that was opened there";
  CameraSelector fresh = selector("usb:/dev/video0");
  EXPECT_EQ(told(fresh.open({})), "scripted: is not there") << "no camera was opened there";
}

TEST_F(CameraSelectorTest, FollowsNoOtherCameraOfTheSameModel) {
  const auto device = usb_->add("046d:0825", {sound_}, "/dev/video0", "A");
  const auto twin = usb_->add("046d:0826", {sound_}, "/dev/video2", "B");
  device->repeatsLast = twin->repeatsLast = true;
  for (const char* path : {"usb-0:1", ""}) {
    device->description.path = path;
    device->description.node = "/dev/video0";
    CameraSelector chosen = selector("usb:/dev/video0");
    EXPECT_EQ(told(chosen.open({})), "usb:046d:0825");
    device->description.path = "usb-0:4";  // unplugged
    device->description.node = "/dev/video9";
    twin->description.path = path;  // in its place, where that is known
    EXPECT_EQ(told(chosen.open({})), "scripted: is not there") << path;
  }
}

TEST_F(CameraSelectorTest, ABackEndsFirstThatWorks) {
  usb_->add("a", {busy_});
  usb_->add("b", {sound_});
  EXPECT_EQ(opened("usb"), "usb:b");
}

TEST_F(CameraSelectorTest, AutoTakesTheFirstDeviceThatWorksOfAllBackEnds) {
  files_->add("film", {sound_});
  EXPECT_EQ(opened("auto"),
            "auto: there is no camera; plug one in, or choose another camera.source")
      << "a recording is no camera";
  usb_->add("a", {sound_});
  EXPECT_EQ(opened("auto"), "usb:a");
  csi_->add("z", {sound_});
  EXPECT_EQ(opened("auto"), "csi:z");
}

TEST_F(CameraSelectorTest, SaysOfEachWhyItDoesNotWork) {
  csi_->failListing(scriptedError(ErrorKind::kIo, "cannot list"));
  usb_->add("a", {busy_});
  usb_->add("b", {sound_})->description.problem =
      scriptedError(ErrorKind::kPermissionDenied, "may not be opened");
  CameraSelector chosen = selector("auto");
  const Result<OpenedCamera> none = chosen.open({});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kNotFound) << "they differ";
  EXPECT_EQ(none.error().message(),
            "auto: no camera works: 1) scripted: cannot list; 2) scripted: is in use; 3) scripted: "
            "may not be opened; plug one in, or choose another camera.source");
}

TEST_F(CameraSelectorTest, HasTheKindThatAllReasonsShare) {
  usb_->add("a", {busy_});
  usb_->add("b", {busy_});
  CameraSelector chosen = selector("auto");
  EXPECT_EQ(chosen.open({}).error().kind, ErrorKind::kBusy);
}

TEST_F(CameraSelectorTest, OneThatWasNamedAnswersForItself) {
  usb_->add("a", {busy_});
  CameraSelector chosen = selector("usb:a");
  const Result<OpenedCamera> none = chosen.open({});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().kind, ErrorKind::kBusy);
  EXPECT_EQ(none.error().message(), "scripted: is in use");
}

TEST_F(CameraSelectorTest, SaysWhichSerialsAreThere) {
  EXPECT_EQ(opened("usb:a"), "scripted: is not there") << "the back end says so itself";
  EXPECT_EQ(opened("serial:1"),
            "serial:1: no camera with that serial number is there; none that is there has one");
  usb_->add("b", {sound_}, "/dev/video0", "S1");
  usb_->add("c", {sound_});
  EXPECT_EQ(opened("serial:1"),
            "serial:1: no camera with that serial number is there; there are: S1");
  csi_->failListing(scriptedError(ErrorKind::kIo, "cannot list"));
  EXPECT_THAT(opened("serial:1"), HasSubstr("is there; scripted: cannot list;"));
}

TEST_F(CameraSelectorTest, RefusesWhatIsNoChoiceBeforeAnythingIsOpened) {
  for (const std::string choice : {"webcam", "serial", "serial:", "auto:", ":a"}) {
    const CameraSelector chosen = selector(choice);
    const Result<void> checked = chosen.check();
    ASSERT_FALSE(checked) << choice;
    EXPECT_EQ(checked.error().kind, ErrorKind::kInvalidArgument);
    EXPECT_EQ(checked.error().message(),
              choice +
                  ": is no camera; choose one of: auto, serial:NUMBER, csi, csi:ID, usb, "
                  "usb:ID, files, files:ID");
    EXPECT_EQ(opened(choice), checked.error().message());
  }
  for (const std::string choice : {"auto", "serial:1", "csi", "usb:anything"}) {
    EXPECT_TRUE(selector(choice).check()) << choice;
  }
}

TEST_F(CameraSelectorTest, AnEmptyChoiceIsNone) {
  EXPECT_THAT(opened(""), testing::StartsWith("\"\": is no camera; choose one of: auto,"));
}

TEST_F(CameraSelectorTest, OneThatWasOfNoUseIsTriedLastUntilItIs) {
  const auto first = usb_->add("a", {sound_});
  const auto second = usb_->add("b", {sound_});
  first->repeatsLast = second->repeatsLast = true;
  CameraSelector chosen = selector("auto");
  EXPECT_EQ(told(chosen.open({})), "usb:a");
  chosen.putLast(first->description.identity);
  EXPECT_EQ(told(chosen.open({})), "usb:b");
  chosen.putLast(second->description.identity);
  EXPECT_EQ(told(chosen.open({})), "usb:a") << "the other failed later";
  chosen.wasOfUse(first->description.identity);
  chosen.wasOfUse(second->description.identity);
  EXPECT_EQ(told(chosen.open({})), "usb:a");
  EXPECT_EQ(first->alive + second->alive, 0);
}

TEST_F(CameraSelectorTest, WrapsDevicesOnly) {
  usb_->add("a", {sound_});
  files_->add("film", {sound_});
  int wrapped = 0;
  const CameraWrapper wrapper = [&](const CameraFactory& make, const std::stop_token&) {
    ++wrapped;
    return make(clock_);
  };
  for (const std::string choice : {"usb", "files"}) {
    CameraSelector chosen({{.backend = usb_}, {.backend = files_, .isDevice = false}}, choice,
                          clock_, wrapper);
    const Result<OpenedCamera> camera = chosen.open({});
    ASSERT_TRUE(camera);
    EXPECT_EQ(camera->isDevice, choice == "usb");
    EXPECT_EQ(wrapped, 1);
  }
}

}  // namespace
}  // namespace pleinair::hal
