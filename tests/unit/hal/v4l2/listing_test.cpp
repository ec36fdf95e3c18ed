#include "hal/cameras/v4l2/find_device.h"
#include "hal/cameras/v4l2/v4l2_kind.h"
#include "hal/v4l2/written_nodes.h"
#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class V4l2Listing : public FakeCamera {
 protected:
  void plugAt(const std::string& name, support::FakeVideo video) {
    video.node = "/dev/" + name;
    kernel_.plug(std::move(video));
    nodes_.folders["/dev"].push_back(name);
  }
  void link(const std::string& folder, const std::string& name, const std::string& node) {
    nodes_.folders[folder].push_back(name);
    nodes_.links[folder + "/" + name] = node;
  }
  std::vector<CameraDescription> listed() {
    Result<std::vector<CameraDescription>> cameras = backend_.list();
    EXPECT_TRUE(cameras);
    EXPECT_EQ(kernel_.descriptors(), 0) << "nothing stays open";
    return std::move(cameras).value_or(std::vector<CameraDescription>());
  }
  std::vector<std::string> ids() {
    std::vector<std::string> ids;
    for (const CameraDescription& camera : listed()) ids.push_back(camera.identity.id);
    return ids;
  }

  V4l2Backend backend_{system()};
};

TEST_F(V4l2Listing, IsEmptyWithoutDevices) {
  EXPECT_EQ(backend_.name(), "v4l2");
  EXPECT_TRUE(listed().empty());
}

TEST_F(V4l2Listing, LeavesEndsOfPipelinesToLibcamera) {
  plugAt("video0", {.caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING | V4L2_CAP_IO_MC});
  plugAt("video1", {.card = "Webcam"});
  const auto cameras = listed();
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].node, "/dev/video1");
}

TEST_F(V4l2Listing, LeavesOutWhatTheProgramItselfFeeds) {
  plugAt("video50", {.card = "loop50"});
  {
    const WrittenNode first("/dev/video50");
    const WrittenNode second("/dev/video50");
    EXPECT_TRUE(listed().empty());
    EXPECT_FALSE(findNode(system(), "platform:loop50-index0"));
  }
  EXPECT_EQ(listed().size(), 1u);
}

TEST_F(V4l2Listing, LeavesControlCharactersOutOfNames) {
  plugAt("video0", {.card = "Web\x1b[2Jcam\n"});
  EXPECT_EQ(listed().at(0).identity.description, "Web?[2Jcam?");
}

TEST_F(V4l2Listing, DescribesACamera) {
  plugAt("video0", {.card = "HD Webcam"});
  link("/dev/v4l/by-id", "usb-Acme_HD_Webcam_0042-video-index0", "/dev/video0");
  nodes_.files["/sys/class/video4linux/video0/device/../serial"] = "0042";
  const auto cameras = listed();
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].identity.backend, "v4l2");
  EXPECT_EQ(cameras[0].identity.id, "usb-Acme_HD_Webcam_0042-video-index0");
  EXPECT_EQ(cameras[0].identity.description, "HD Webcam");
  EXPECT_EQ(cameras[0].serial, "0042");
  EXPECT_EQ(cameras[0].node, "/dev/video0");
  EXPECT_FALSE(cameras[0].problem);
  ASSERT_EQ(cameras[0].modes.size(), 1u);
  EXPECT_EQ(cameras[0].modes[0].size, (FrameSize{64, 48}));
}

TEST_F(V4l2Listing, GoesByNumberAndLeavesOutWhatIsNoCamera) {
  plugAt("video10", {.card = "Ten"});
  plugAt("video2", {.card = "Two"});
  plugAt("video3", {.card = "Out", .caps = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING});
  plugAt("video4", {.card = "Meta", .caps = V4L2_CAP_META_CAPTURE | V4L2_CAP_STREAMING});
  plugAt("video5", {.card = "Codec",
                    .caps = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_M2M | V4L2_CAP_STREAMING});
  plugAt("radio0", {.card = "Radio"});
  plugAt("videos", {.card = "Odd name"});
  EXPECT_THAT(ids(), ElementsAre("platform:fake-000-Two-index0", "platform:fake-000-Ten-index0"));
}

TEST_F(V4l2Listing, PrefersTheNameThatDoesNotDependOnTheSocket) {
  plugAt("video0", {});
  link("/dev/v4l/by-path", "pci-0000:00:14.0-usb-0:4:1.0-video-index0", "/dev/video0");
  EXPECT_THAT(ids(), ElementsAre("pci-0000:00:14.0-usb-0:4:1.0-video-index0"));
  link("/dev/v4l/by-id", "usb-Acme-video-index0", "/dev/video0");
  EXPECT_THAT(ids(), ElementsAre("usb-Acme-video-index0"));
}

TEST_F(V4l2Listing, TellsTwoAlikeApart) {
  plugAt("video0", {.card = "Same"});
  plugAt("video1", {.card = "Same"});
  nodes_.files["/sys/class/video4linux/video0/index"] = "0";
  nodes_.files["/sys/class/video4linux/video1/index"] = "1";
  EXPECT_THAT(ids(), ElementsAre("platform:fake-000-Same-index0", "platform:fake-000-Same-index1"));
  nodes_.files.clear();
  EXPECT_THAT(ids(), ElementsAre("platform:fake-000-Same-index0", "/dev/video1"));
}

TEST_F(V4l2Listing, CountsALoopbackWhileItIsFed) {
  constexpr std::uint32_t kBothSides =
      V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  plugAt("video0", {.card = "Idle", .caps = kBothSides, .formats = {}});
  EXPECT_TRUE(listed().empty());
  plugAt("video1", {.card = "Fed (0x01)", .caps = kBothSides});
  EXPECT_THAT(ids(), ElementsAre("platform:fake-000-Fed__0x01_-index0"));
}

TEST_F(V4l2Listing, SaysWhyADeviceCannotBeLookedAt) {
  plugAt("video0", {.openFailure = EACCES});
  link("/dev/v4l/by-id", "usb-Acme-video-index0", "/dev/video0");
  nodes_.files["/sys/class/video4linux/video0/name"] = "HD Webcam";
  const auto cameras = listed();
  ASSERT_EQ(cameras.size(), 1u);
  EXPECT_EQ(cameras[0].identity.id, "usb-Acme-video-index0");
  EXPECT_EQ(cameras[0].identity.description, "HD Webcam");
  ASSERT_TRUE(cameras[0].problem);
  EXPECT_EQ(cameras[0].problem->kind, ErrorKind::kPermissionDenied);
}

TEST_F(V4l2Listing, MakesWhatItLists) {
  plugAt("video0", {.card = "First"});
  plugAt("video1", {.card = "Second", .bus = "usb-1"});
  for (const char* id : {"usb-1-Second-index0", "/dev/video1"}) {
    const std::unique_ptr<Camera> camera = backend_.make(id, clock_);
    EXPECT_EQ(camera->identity().id, id);
    ASSERT_TRUE(camera->start({}));
    EXPECT_EQ(camera->identity().id, id);
    EXPECT_EQ(camera->identity().description, "Second at /dev/video1");
  }
}

TEST_F(V4l2Listing, FindsACameraThatHasMovedToAnotherNode) {
  plugAt("video0", {});
  link("/dev/v4l/by-id", "usb-Acme-video-index0", "/dev/video0");
  const std::unique_ptr<Camera> camera = backend_.make("usb-Acme-video-index0", clock_);
  ASSERT_TRUE(camera->start({}));
  camera->stop();
  kernel_.unplug("/dev/video0", ENODEV);
  nodes_.folders["/dev"].clear();
  plugAt("video1", {.card = "Again"});
  nodes_.links["/dev/v4l/by-id/usb-Acme-video-index0"] = "/dev/video1";
  ASSERT_TRUE(camera->start({}));
  EXPECT_EQ(camera->identity().description, "Again at /dev/video1");
}

class V4l2StaleLinks : public V4l2Listing {
 protected:
  /// Adds the sysfs entries of a node of a USB camera at this port.
  void describeUsb(const std::string& name, const std::string& port) {
    const std::string host = "/sys/devices/pci0000:00/0000:00:14.0";
    const std::string device = host + "/usb1/1-" + port;
    const std::string interface = device + "/1-" + port + ":1.0";
    nodes_.links["/sys/class/video4linux/" + name + "/device"] = interface;
    nodes_.links[interface + "/subsystem"] = "/sys/bus/usb";
    nodes_.links[device + "/subsystem"] = "/sys/bus/usb";
    nodes_.links[host + "/usb1/subsystem"] = "/sys/bus/usb";
    nodes_.links[host + "/subsystem"] = "/sys/bus/pci";
    nodes_.files["/sys/class/video4linux/" + name + "/index"] = "0";
  }
  void describePlatform(const std::string& name, const std::string& device) {
    nodes_.links["/sys/class/video4linux/" + name + "/device"] = "/sys/devices/platform/" + device;
    nodes_.links["/sys/devices/platform/" + device + "/subsystem"] = "/sys/bus/platform";
    nodes_.files["/sys/class/video4linux/" + name + "/index"] = "0";
  }
  std::string openedAs(const std::string& id) {
    const std::unique_ptr<Camera> camera = backend_.make(id, clock_);
    const Result<StreamFormat> format = camera->start({});
    return format ? camera->identity().description : format.error().message();
  }
};

TEST_F(V4l2StaleLinks, AByPathLinkThatUdevHasNotMovedYetIsNotFollowed) {
  plugAt("video0", {.openFailure = ENODEV});  // what the driver left behind
  plugAt("video1", {.card = "Reset"});
  describePlatform("video1", "vivid.0");
  link("/dev/v4l/by-path", "platform-vivid.0-video-index0", "/dev/video0");
  EXPECT_EQ(openedAs("platform-vivid.0-video-index0"), "Reset at /dev/video1");
}

TEST_F(V4l2StaleLinks, TheirCamerasAreListedWithTheirPath) {
  plugAt("video1", {.card = "Reset"});
  describePlatform("video1", "vivid.0");
  link("/dev/v4l/by-path", "platform-vivid.0-video-index0", "/dev/video0");
  plugAt("video2", {.card = "Unknown"});
  const auto cameras = listed();
  ASSERT_EQ(cameras.size(), 2u);
  EXPECT_EQ(cameras[0].path, "platform-vivid.0-video-index0");
  EXPECT_EQ(cameras[1].path, "") << "the kernel does not say";
}

TEST_F(V4l2StaleLinks, ALinkToANodeThatAnotherCameraHasTakenIsNotFollowed) {
  constexpr const char* kFormer = "pci-0000:00:14.0-usb-0:4:1.0-video-index0";
  plugAt("video0", {.card = "Other"});
  describeUsb("video0", "2");
  link("/dev/v4l/by-path", kFormer, "/dev/video0");
  EXPECT_THAT(openedAs(kFormer), HasSubstr("no V4L2 camera with this id is connected"));
  plugAt("video3", {.card = "Same"});
  describeUsb("video3", "4");
  EXPECT_EQ(openedAs(kFormer), "Same at /dev/video3");
  EXPECT_EQ(openedAs("pci-0000:00:14.0-usb-0:2:1.0-video-index0"), "Other at /dev/video0");
}

TEST_F(V4l2StaleLinks, AByIdLinkOfAnotherSerialIsNotFollowed) {
  constexpr const char* kFormer = "usb-Acme_Inc_HD_Webcam_0042-video-index0";
  const auto describe = [&](const std::string& name, const std::string& serial) {
    const std::string device = "/sys/class/video4linux/" + name + "/device/../";
    nodes_.files[device + "manufacturer"] = "Acme Inc";
    nodes_.files[device + "product"] = "HD Webcam";
    nodes_.files[device + "serial"] = serial;
  };
  plugAt("video0", {.card = "Other"});
  describe("video0", "0077");
  link("/dev/v4l/by-id", kFormer, "/dev/video0");
  EXPECT_THAT(openedAs(kFormer), HasSubstr("no V4L2 camera with this id is connected"));
  EXPECT_THAT(ids(), ElementsAre("platform:fake-000-Other-index0")) << "not by the stale link";
  plugAt("video1", {.card = "Same"});
  describe("video1", "0042");
  EXPECT_EQ(openedAs(kFormer), "Same at /dev/video1");
}

TEST_F(V4l2StaleLinks, TheNameWithTheVersionOfUsbIsTheSameDevices) {
  constexpr const char* kVersioned = "pci-0000:00:14.0-usbv2-0:4:1.0-video-index0";
  plugAt("video0", {.card = "Same"});
  describeUsb("video0", "4");
  link("/dev/v4l/by-path", kVersioned, "/dev/video0");
  EXPECT_EQ(openedAs(kVersioned), "Same at /dev/video0");
}

TEST_F(V4l2Listing, SaysWhatThereIsWhereAnIdIsNot) {
  plugAt("video0", {});
  const Result<StreamFormat> format = backend_.make("usb-Gone", clock_)->start({});
  ASSERT_FALSE(format);
  EXPECT_EQ(format.error().kind, ErrorKind::kNotFound);
  EXPECT_THAT(
      format.error().message(),
      HasSubstr("usb-Gone: no V4L2 camera with this id is connected; plug it in, or choose one "
                "of platform:fake-000-Fake_camera-index0"));
}

}  // namespace
}  // namespace pleinair::hal::v4l2
