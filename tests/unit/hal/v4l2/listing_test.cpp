#include "hal/cameras/v4l2/v4l2_backend.h"
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
