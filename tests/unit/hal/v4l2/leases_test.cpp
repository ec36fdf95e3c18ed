// The ownership of the driver's buffers over time.
#include <thread>

#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

class V4l2Leases : public FakeCamera {
 protected:
  static bool isInDriversMemory(const CapturedFrame& frame) { return frame.dmaBufs[0].fd >= 0; }
};

TEST_F(V4l2Leases, AreTheDriversMemoryWithItsDmaBuf) {
  plug({.formats = {{.fourcc = V4L2_PIX_FMT_NV12}}, .rowPadding = 32});
  startOrFail();
  const CapturedFrame frame = frameOrFail();
  expectPicture(frame, 0);
  EXPECT_EQ(frame.image.map().view().planes[0].strideBytes, 96u);
  EXPECT_GE(frame.dmaBufs[0].fd, 0);
  EXPECT_EQ(frame.dmaBufs[1].fd, frame.dmaBufs[0].fd);
  EXPECT_EQ(frame.dmaBufs[0].offsetBytes, 0u);
  EXPECT_EQ(frame.dmaBufs[1].offsetBytes, 96u * 48u);
  EXPECT_EQ(frame.dmaBufs[2].fd, -1);
}

TEST_F(V4l2Leases, OfPlanesApartHaveADmaBufEach) {
  plug({.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING,
        .formats = {{.fourcc = V4L2_PIX_FMT_NV12M}}});
  startOrFail();
  const CapturedFrame frame = frameOrFail();
  expectPicture(frame, 0);
  EXPECT_GE(frame.dmaBufs[1].fd, 0);
  EXPECT_NE(frame.dmaBufs[1].fd, frame.dmaBufs[0].fd);
  EXPECT_EQ(frame.dmaBufs[1].offsetBytes, 0u);
}

TEST_F(V4l2Leases, DoWithoutDmaBufsWhereTheDriverExportsNone) {
  plug({.exportsDmaBufs = false});
  startOrFail();
  const CapturedFrame frame = frameOrFail();
  EXPECT_FALSE(isInDriversMemory(frame));
  expectPicture(frame, 0);
}

TEST_F(V4l2Leases, AreCopiesOnceTheDriverWouldHaveNothingLeft) {
  plug({.mostBuffers = 4});
  startOrFail();
  std::vector<CapturedFrame> held;
  for (int i = 0; i < 12; ++i) held.push_back(frameOrFail());
  for (int i = 0; i < 12; ++i) {
    const CapturedFrame& frame = held[static_cast<std::size_t>(i)];
    EXPECT_EQ(isInDriversMemory(frame), i < 3) << i;
    EXPECT_EQ(frame.sequence, static_cast<unsigned>(i));
    expectPicture(frame, i);
  }
  held.clear();
  EXPECT_TRUE(isInDriversMemory(frameOrFail())) << "the buffers are back";
}

TEST_F(V4l2Leases, ThatStarveTheDriverAreCountedApart) {
  plug({.mostBuffers = 4});
  startOrFail();
  std::vector<CapturedFrame> held;
  for (int i = 0; i < 3; ++i) held.push_back(frameOrFail());
  clock_.advance(200ms);  // five frames for one buffer
  const CapturedFrame last = frameOrFail();
  EXPECT_EQ(last.droppedBefore, 0u) << "the buffer's frame came first";
  held.push_back(last);
  const CapturedFrame afterGap = frameOrFail();
  EXPECT_EQ(afterGap.droppedBefore, 4u);
  EXPECT_EQ(afterGap.underrunsBefore, 4u);
}

TEST_F(V4l2Leases, AreNotBlamedForWhatTheDeviceLoses) {
  plug({.frames = {{2, {.skipped = 3}}}});
  startOrFail();
  frameOrFail();
  frameOrFail();
  const CapturedFrame frame = frameOrFail();
  EXPECT_EQ(frame.sequence, 5u);
  EXPECT_EQ(frame.droppedBefore, 3u);
  EXPECT_EQ(frame.underrunsBefore, 0u);
}

TEST_F(V4l2Leases, OutliveStopAndCamera) {
  plug();
  startOrFail();
  CapturedFrame first = frameOrFail();
  CapturedFrame second = frameOrFail();
  camera().stop();
  EXPECT_EQ(kernel_.descriptors(), 0);
  EXPECT_EQ(kernel_.buffers(), 2) << "the others are free";
  expectPicture(first, 0);
  startOrFail();  // the device is free for its next stream
  expectPicture(frameOrFail(), 0);
  destroyCamera();
  expectPicture(second, 1);
  EXPECT_EQ(kernel_.dmaBufs(), 2);
  first = {};
  std::thread([frame = std::exchange(second, {})]() mutable { frame = {}; }).join();
  expectNothingLeft();
}

TEST_F(V4l2Leases, KeepAnOldDriverBusyUntilTheyGo) {
  plug({.keepsMappedBuffers = true});
  startOrFail();
  CapturedFrame held = frameOrFail();
  camera().stop();
  EXPECT_EQ(startError().kind, ErrorKind::kBusy);
  expectPicture(held, 0);
  held = {};
  startOrFail();
  frameOrFail();
}

TEST_F(V4l2Leases, AreDroppedOnAnotherThreadWhileTheCameraStreams) {
  plug({.mostBuffers = 4});
  startOrFail();
  std::mutex mutex;
  std::vector<CapturedFrame> handed;
  std::uint64_t sum = 0;
  std::jthread consumer([&](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      std::vector<CapturedFrame> taken;
      {
        const std::scoped_lock lock(mutex);
        taken.swap(handed);
      }
      for (const CapturedFrame& frame : taken) sum += frame.image.map().view().row(0, 0)[0];
    }
  });
  for (int i = 0; i < 500; ++i) {
    CapturedFrame frame = frameOrFail();
    const std::scoped_lock lock(mutex);
    handed.push_back(std::move(frame));
  }
  consumer.request_stop();
  consumer.join();
  handed.clear();
  EXPECT_GT(sum, 0u);
  destroyCamera();
  expectNothingLeft();
}

TEST_F(V4l2Leases, ComeBackOverAHundredStartsAndStops) {
  plug({.formats = {{.fourcc = V4L2_PIX_FMT_NV12}}});
  std::optional<CapturedFrame> fromBefore;
  for (int cycle = 0; cycle < 100; ++cycle) {
    startOrFail();
    CapturedFrame frame = frameOrFail();
    expectPicture(frame, 0);
    if (cycle % 2 == 0) fromBefore = std::move(frame);  // held across the next start
    camera().stop();
  }
  EXPECT_EQ(kernel_.opens(), 100);
  fromBefore.reset();
  expectNothingLeft();
}

}  // namespace
}  // namespace pleinair::hal::v4l2
