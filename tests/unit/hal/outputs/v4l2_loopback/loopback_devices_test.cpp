#include "hal/outputs/v4l2_loopback/loopback_devices.h"

#include <gmock/gmock.h>

#include "tests/unit/hal/outputs/v4l2_loopback/loopback_fixture.h"

namespace pleinair::hal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class LoopbackDevices : public LoopbackTest {
 protected:
  Error errorOf(const std::string& name) {
    const Result<std::string> node = findLoopback(name, system());
    EXPECT_FALSE(node);
    return node ? Error{} : node.error();
  }
};

TEST_F(LoopbackDevices, AreListedByNumber) {
  for (const char* name : {"video10", "video2", "video1"}) addNode(name);
  for (const char* other : {"video", "videox", "video-1", "video3x", "media0"}) {
    std::ofstream(folder_.path() / other).flush();
  }
  std::vector<std::string> nodes;
  for (const LoopbackDevice& device : listLoopbacks(system())) nodes.push_back(device.node);
  EXPECT_THAT(nodes, ElementsAre(pathOf("video1"), pathOf("video2"), pathOf("video10")));
  EXPECT_EQ(fake_.openDescriptors(), 0u);
}

TEST_F(LoopbackDevices, TellWhatTheyAre) {
  addNode("video0").capabilities = V4L2_CAP_VIDEO_CAPTURE;  // another program writes to it
  support::FakeOutputNode& camera = addNode("video1");
  camera.driver = "uvcvideo";
  camera.capabilities = V4L2_CAP_VIDEO_CAPTURE;
  support::FakeOutputNode& vivid = addNode("video2");
  vivid.driver = "vivid";
  vivid.capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_READWRITE;
  addNode("video3").openAnswer = -EACCES;
  const std::vector<LoopbackDevice> devices = listLoopbacks(system());
  ASSERT_EQ(devices.size(), 3u) << "no output side";
  EXPECT_TRUE(devices[0].isLoopback);
  EXPECT_FALSE(devices[0].isWritable);
  EXPECT_TRUE(devices[0].isReadable);
  EXPECT_FALSE(devices[1].isLoopback);
  EXPECT_TRUE(devices[1].isWritable);
  EXPECT_THAT(devices[1].layouts, ElementsAre("YUYV", "NV12", "YU12"));
  ASSERT_TRUE(devices[2].problem);
  EXPECT_EQ(devices[2].problem->kind, ErrorKind::kPermissionDenied);
}

TEST_F(LoopbackDevices, AreNoneWithoutAFolder) {
  EXPECT_THAT(listLoopbacks({.calls = &fake_, .nodes = folder_.path() / "none"}), IsEmpty());
}

TEST_F(LoopbackDevices, AreFoundByNothingByLabelAndByNode) {
  support::FakeOutputNode& other = addNode("video0");
  other.driver = "vivid";
  other.card = "vivid";
  addNode("video4").card = "first one";
  addNode("video5").card = "second";
  EXPECT_EQ(findLoopback("", system()).value_or(""), pathOf("video4"));
  EXPECT_EQ(findLoopback("second", system()).value_or(""), pathOf("video5"));
  EXPECT_EQ(findLoopback("first one", system()).value_or(""), pathOf("video4"));
  EXPECT_EQ(findLoopback("vivid", system()).value_or(""), pathOf("video0"));
  EXPECT_EQ(findLoopback("/dev/video77", system()).value_or(""), "/dev/video77");
}

TEST_F(LoopbackDevices, OneThatIsWrittenToIsPassedOver) {
  addNode("video4").capabilities = V4L2_CAP_VIDEO_CAPTURE;
  addNode("video5");
  EXPECT_EQ(findLoopback("", system()).value_or(""), pathOf("video5"));
}

TEST_F(LoopbackDevices, AllWrittenToAreBusy) {
  addNode("video4").capabilities = V4L2_CAP_VIDEO_CAPTURE;
  const Error error = errorOf("");
  EXPECT_EQ(error.kind, ErrorKind::kBusy);
  EXPECT_THAT(error.message(), HasSubstr("another program writes to it"));
  EXPECT_THAT(error.message(), HasSubstr("modprobe -r v4l2loopback"));
}

TEST_F(LoopbackDevices, NoneSaysHowToLoadTheModule) {
  const Error error = errorOf("");
  EXPECT_EQ(error.kind, ErrorKind::kNotFound);
  EXPECT_THAT(error.message(), HasSubstr("modprobe v4l2loopback video_nr=50"));
}

TEST_F(LoopbackDevices, AnUnknownLabelNamesThoseThere) {
  addNode("video4").card = "hall";
  const Error error = errorOf("hal");
  EXPECT_EQ(error.kind, ErrorKind::kNotFound);
  EXPECT_THAT(error.message(), HasSubstr(pathOf("video4") + " (hall)"));
}

TEST_F(LoopbackDevices, WithoutPermissionSayHowToGetIt) {
  addNode("video4").openAnswer = -EACCES;
  for (const char* name : {"", "hall"}) {
    const Error error = errorOf(name);
    EXPECT_EQ(error.kind, ErrorKind::kPermissionDenied);
    EXPECT_THAT(error.message(), HasSubstr("usermod -aG video"));
  }
}

TEST_F(LoopbackDevices, AreOpenedByNameAndRefusedWithTheReason) {
  addNode("video4").card = "hall";
  const Result<OpenLoopback> opened = openLoopbackNode("hall", system());
  ASSERT_TRUE(opened);
  EXPECT_EQ(opened->node, pathOf("video4"));
  EXPECT_TRUE(opened->descriptor);
  addNode("video5").capabilities = V4L2_CAP_VIDEO_CAPTURE;
  addNode("video6").openAnswer = -EACCES;
  support::FakeOutputNode& streaming = addNode("video7");
  streaming.driver = "vivid";
  streaming.capabilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  const auto kindOf = [&](const char* name) {
    const Result<OpenLoopback> refused = openLoopbackNode(pathOf(name), system());
    EXPECT_FALSE(refused) << name;
    return refused ? ErrorKind::kIo : refused.error().kind;
  };
  EXPECT_EQ(kindOf("video5"), ErrorKind::kBusy);
  EXPECT_EQ(kindOf("video6"), ErrorKind::kPermissionDenied);
  EXPECT_EQ(kindOf("video7"), ErrorKind::kUnsupported) << "it takes buffers only";
  EXPECT_EQ(kindOf("video8"), ErrorKind::kNotFound);
  EXPECT_EQ(fake_.openDescriptors(), 1u) << "the one that is kept";
}

TEST_F(LoopbackDevices, ThatAreNoV4l2AreToldByTheRealCalls) {
  std::ofstream(folder_.path() / "video0") << "a file";
  const std::vector<LoopbackDevice> devices = listLoopbacks({.nodes = folder_.path()});
  ASSERT_EQ(devices.size(), 1u);
  ASSERT_TRUE(devices[0].problem);
  EXPECT_EQ(devices[0].problem->kind, ErrorKind::kUnsupported);
}

}  // namespace
}  // namespace pleinair::hal
