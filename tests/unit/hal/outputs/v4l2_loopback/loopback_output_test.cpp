#include "hal/outputs/v4l2_loopback/loopback_output.h"

#include <filesystem>
#include <iterator>

#include <gmock/gmock.h>

#include "hal/outputs/registry.h"
#include "hal/v4l2/written_nodes.h"
#include "tests/unit/hal/outputs/v4l2_loopback/loopback_fixture.h"

namespace pleinair::hal {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

class LoopbackOutput : public LoopbackTest {};

TEST_F(LoopbackOutput, WritesAWholeFrameAWrite) {
  support::FakeOutputNode& node = addNode("video0");
  node.alignment = 64;
  for (const PixelFormat layout : {PixelFormat::kYuyv, PixelFormat::kNv12, PixelFormat::kI420}) {
    node.written.clear();
    const auto output = open("loopback", layout);
    const FrameFormat format = startOrFail(*output, {36, 18});
    ASSERT_EQ(format.pixelFormat, layout);
    const Image image = picture(format);
    ASSERT_TRUE(output->write(image.view(), {}));
    ASSERT_EQ(node.written.size(), 1u);
    EXPECT_EQ(node.written[0].size(), node.format.sizeimage);
    const auto begin = node.written[0].begin() + node.format.bytesperline;
    const auto row = image.view().row(0, 1);
    EXPECT_TRUE(std::equal(row.begin(), row.end(), begin)) << "the second row after the stride";
  }
}

TEST_F(LoopbackOutput, IsNoCameraOfTheSameProgram) {
  addNode("video0");
  {
    const auto output = open("loopback");
    EXPECT_FALSE(v4l2::isWritten(pathOf("video0")));
    startOrFail(*output);
    EXPECT_TRUE(v4l2::isWritten(pathOf("video0")));
    ASSERT_TRUE(output->finish());
    EXPECT_FALSE(v4l2::isWritten(pathOf("video0")));
    startOrFail(*output);
  }
  EXPECT_FALSE(v4l2::isWritten(pathOf("video0")));
}

TEST_F(LoopbackOutput, NeverWaitsForReaders) {
  support::FakeOutputNode& node = addNode("video0");
  const auto output = open("loopback");
  const FrameFormat format = startOrFail(*output);
  EXPECT_FALSE(node.wasOpenedBlocking);
  const Image image = picture(format);
  node.writeAnswers.assign(100, -EAGAIN);  // a reader that never reads
  for (int i = 0; i < 100; ++i) {
    const Result<void> written = output->write(image.view(), i * milliseconds(40));
    ASSERT_TRUE(written) << written.error().message();
  }
  EXPECT_EQ(output->skippedPictures(), 100u);
  EXPECT_TRUE(node.written.empty());
  ASSERT_TRUE(output->write(image.view(), milliseconds(4000))) << "and now it reads";
  EXPECT_EQ(node.written.size(), 1u);
  EXPECT_EQ(output->skippedPictures(), 100u);
}

TEST_F(LoopbackOutput, TellsADeviceThatIsLost) {
  for (const int code : {ENODEV, EIO, ENXIO}) {
    support::FakeOutputNode& node = addNode("video0");
    const auto output = open("loopback");
    const Image image = picture(startOrFail(*output));
    node.writeAnswers = {-code};
    const Result<void> written = output->write(image.view(), {});
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().kind, ErrorKind::kDeviceLost);
    EXPECT_EQ(written.error().code, code);
    EXPECT_THAT(written.error().message(), HasSubstr(pathOf("video0")));
  }
}

TEST_F(LoopbackOutput, IsLostWhereTheModuleIsUnloaded) {
  addNode("video0");
  const auto output = open("loopback");
  const Image image = picture(startOrFail(*output));
  removeNode("video0");
  const Result<void> written = output->write(image.view(), {});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kDeviceLost);
}

TEST_F(LoopbackOutput, TellsOtherFailuresOfWrite) {
  support::FakeOutputNode& node = addNode("video0");
  const auto output = open("loopback");
  const Image image = picture(startOrFail(*output));
  node.writeAnswers = {-EINVAL, -EBUSY, 100};
  EXPECT_EQ(output->write(image.view(), {}).error().kind, ErrorKind::kIo);
  EXPECT_EQ(output->write(image.view(), {}).error().kind, ErrorKind::kBusy);
  const Result<void> shortWrite = output->write(image.view(), {});
  ASSERT_FALSE(shortWrite);
  EXPECT_EQ(shortWrite.error().kind, ErrorKind::kIo);
  EXPECT_THAT(shortWrite.error().message(), HasSubstr("took 100 of the 1024 bytes"));
}

TEST_F(LoopbackOutput, StartsAndStopsTheStream) {
  support::FakeOutputNode& node = addNode("video0");
  {
    const auto output = open("loopback");
    startOrFail(*output);
    EXPECT_EQ(node.startCount, 1) << "else 0.12 takes no pictures once this is closed";
    ASSERT_TRUE(output->finish());
    EXPECT_EQ(node.stopCount, 1);
    EXPECT_EQ(node.openNow, 0);
  }
  EXPECT_EQ(node.stopCount, 1);
  {
    const auto abandoned = open("loopback");
    startOrFail(*abandoned);
  }
  EXPECT_EQ(node.stopCount, 2);
  node.startsWithoutBuffers = false;  // 0.14
  const auto output = open("loopback");
  const Image image = picture(startOrFail(*output));
  EXPECT_TRUE(output->write(image.view(), {}));
  EXPECT_TRUE(output->finish());
  EXPECT_EQ(node.stopCount, 2);
}

TEST_F(LoopbackOutput, AnnouncesTheRate) {
  support::FakeOutputNode& node = addNode("video0");
  const auto output = open("loopback");
  startOrFail(*output);
  EXPECT_EQ(node.rate.numerator, 1u);
  EXPECT_EQ(node.rate.denominator, 25u);
}

TEST_F(LoopbackOutput, LeaksNothingIn100Cycles) {
  support::FakeOutputNode& node = addNode("video0");
  for (int i = 0; i < 100; ++i) {
    const auto output = open("loopback:" + pathOf("video0"));
    node.setFormatAnswer = i % 3 == 1 ? -EBUSY : 0;
    const Result<OutputFormat> format = start(*output);
    ASSERT_EQ(format.has_value(), i % 3 != 1);
    if (!format) continue;
    const Image image = picture(format->frame);
    ASSERT_TRUE(output->write(image.view(), {}));
    if (i % 3 == 2) {
      ASSERT_TRUE(output->finish());
    }
  }
  EXPECT_EQ(fake_.openDescriptors(), 0u);
  EXPECT_EQ(node.openCount, 100);
  EXPECT_EQ(node.startCount, node.stopCount);
}

TEST_F(LoopbackOutput, LeaksNoDescriptorOfTheSystems) {
  std::ofstream(folder_.path() / "video0") << "a file";
  const auto descriptors = [] {
    const std::filesystem::directory_iterator first("/proc/self/fd");
    return std::distance(first, std::filesystem::directory_iterator());
  };
  const auto before = descriptors();
  for (int i = 0; i < 100; ++i) {
    const auto output = openLoopback("loopback:" + pathOf("video0"));
    ASSERT_TRUE(output);
    const Result<OutputFormat> format = start(**output);
    ASSERT_FALSE(format);
    EXPECT_EQ(format.error().kind, ErrorKind::kUnsupported) << format.error().message();
  }
  EXPECT_EQ(descriptors(), before);
}

TEST_F(LoopbackOutput, SaysWhyItDoesNotOpen) {
  struct Case {
    int code;
    ErrorKind kind;
    const char* remedy;
  };
  support::FakeOutputNode& node = addNode("video0");
  for (const Case& each : {Case{ENOENT, ErrorKind::kNotFound, "modprobe v4l2loopback"},
                           Case{EACCES, ErrorKind::kPermissionDenied, "usermod -aG video"},
                           Case{EBUSY, ErrorKind::kBusy, "max_openers"}}) {
    node.openAnswer = -each.code;
    const Result<OutputFormat> format = start(*open("loopback:" + pathOf("video0")));
    ASSERT_FALSE(format);
    EXPECT_EQ(format.error().kind, each.kind);
    EXPECT_THAT(format.error().message(), HasSubstr(each.remedy));
  }
}

TEST_F(LoopbackOutput, RefusesWhatTakesNoPictures) {
  support::FakeOutputNode& node = addNode("video0");
  node.driver = "uvcvideo";
  node.card = "C920";
  node.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
  Result<OutputFormat> format = start(*open("loopback:" + pathOf("video0")));
  ASSERT_FALSE(format);
  EXPECT_EQ(format.error().kind, ErrorKind::kUnsupported);
  EXPECT_THAT(format.error().message(), HasSubstr("C920"));

  node.driver = "v4l2 loopback";  // exclusive_caps=1, with a writer
  format = start(*open("loopback:" + pathOf("video0")));
  ASSERT_FALSE(format);
  EXPECT_EQ(format.error().kind, ErrorKind::kBusy);
}

TEST_F(LoopbackOutput, RefusesNamesAndLayoutsThatAreNone) {
  for (const char* name : {"loopback:", "loop", "", "window", "loopbacks"}) {
    const auto output = openLoopback(name, {}, system());
    ASSERT_FALSE(output) << name;
    EXPECT_EQ(output.error().kind, ErrorKind::kInvalidArgument);
  }
  const auto output = openLoopback("loopback", PixelFormat::kRgb8, system());
  ASSERT_FALSE(output);
  EXPECT_THAT(output.error().message(), HasSubstr("yuyv, nv12 or i420"));
}

TEST_F(LoopbackOutput, IsWhatOpenOutputGives) {
  for (const char* name : {"loopback", "loopback:/dev/video50", "loopback:hall"}) {
    const auto output = openOutput(name, {{"loopback", {{"format", "nv12"}}}});
    ASSERT_TRUE(output) << output.error().message();
    EXPECT_EQ((*output)->identity().backend, "loopback");
  }
  EXPECT_FALSE(openOutput("loopback:"));
  const auto file = openOutput("loopback.mp4");
  ASSERT_TRUE(file);
  EXPECT_EQ((*file)->identity().backend, "movie");
}

}  // namespace
}  // namespace pleinair::hal
