// Whose memory frames lie in, and which buffer of it.
#include <set>

#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class V4l2Memory : public FakeCamera {
 protected:
  StreamRequest lending(int most = 64) { return {.allocator = kernel_.allocator(most)}; }
};

TEST_F(V4l2Memory, BuffersKeepTheirIdentityAndPlacesWhileTheyAreUsedAgain) {
  plug({.formats = {{.fourcc = V4L2_PIX_FMT_NV12}}, .mostBuffers = 4});
  EXPECT_EQ(startOrFail().memory, FrameMemory::kExported);
  std::map<std::uint32_t, std::array<DmaBufPlane, 3>> places;
  std::uint64_t pool = 0;
  for (int i = 0; i < 20; ++i) {
    const CapturedFrame frame = frameOrFail();
    ASSERT_TRUE(frame.buffer);
    if (i == 0) pool = frame.buffer.pool;
    EXPECT_EQ(frame.buffer.pool, pool);
    const auto [known, isNew] = places.try_emplace(frame.buffer.index, frame.dmaBufs);
    for (std::size_t plane = 0; plane < 3; ++plane) {
      EXPECT_EQ(known->second[plane].fd, frame.dmaBufs[plane].fd);
      EXPECT_EQ(known->second[plane].offsetBytes, frame.dmaBufs[plane].offsetBytes);
    }
  }
  EXPECT_EQ(places.size(), 4u);
}

TEST_F(V4l2Memory, ANewStreamHasOtherBuffers) {
  plug();
  std::set<std::uint64_t> pools;
  for (int i = 0; i < 5; ++i) {
    startOrFail();
    pools.insert(frameOrFail().buffer.pool);
    camera().stop();
  }
  EXPECT_EQ(pools.size(), 5u);
  EXPECT_FALSE(pools.contains(0));
}

TEST_F(V4l2Memory, ACopyHasNoIdentity) {
  plug({.mostBuffers = 2});
  startOrFail();
  const CapturedFrame held = frameOrFail();
  const CapturedFrame copy = frameOrFail();
  EXPECT_TRUE(held.buffer);
  EXPECT_FALSE(copy.buffer);
  EXPECT_EQ(copy.dmaBufs[0].fd, -1);
  EXPECT_FALSE(copy.image.needsAccess());
}

TEST_F(V4l2Memory, DriversMemoryNeedsNoBrackets) {
  plug();
  startOrFail();
  const CapturedFrame frame = frameOrFail();
  EXPECT_FALSE(frame.image.needsAccess()) << "vb2 synchronises its own";
  expectPicture(frame, 0);
  EXPECT_EQ(kernel_.readsBegun(), 0);
}

class V4l2LentMemory : public V4l2Memory, public testing::WithParamInterface<support::FakeVideo> {};

TEST_P(V4l2LentMemory, IsFilledAndReadWithinBrackets) {
  plug(GetParam());
  const StreamFormat format = startOrFail(lending());
  EXPECT_EQ(format.memory, FrameMemory::kLent);
  EXPECT_EQ(format.memoryNote, "fake heap");
  for (int i = 0; i < 15; ++i) {
    const CapturedFrame frame = frameOrFail();
    ASSERT_TRUE(frame.buffer);
    ASSERT_TRUE(frame.image.needsAccess());
    EXPECT_GE(frame.dmaBufs[0].fd, 0);
    EXPECT_EQ(frame.dmaBufs[0].strideBytes, frame.image.strideBytes(0));
    const int before = kernel_.readsBegun();
    {
      const FrameMapping mapped = frame.image.map();
      EXPECT_GT(kernel_.readsGoingOn(), 0);
      const FrameMapping nested = frame.image.map();
    }
    EXPECT_GT(kernel_.readsBegun(), before);
    EXPECT_EQ(kernel_.readsGoingOn(), 0);
    expectPicture(frame, i);
  }
  destroyCamera();
  expectNothingLeft();
}

INSTANTIATE_TEST_SUITE_P(
    Interfaces, V4l2LentMemory,
    testing::Values(support::FakeVideo{.formats = {{.fourcc = V4L2_PIX_FMT_YUYV}}},
                    support::FakeVideo{.formats = {{.fourcc = V4L2_PIX_FMT_NV12}},
                                       .rowPadding = 32},
                    support::FakeVideo{.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING,
                                       .formats = {{.fourcc = V4L2_PIX_FMT_NV12M}}},
                    support::FakeVideo{.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING,
                                       .formats = {{.fourcc = V4L2_PIX_FMT_YUV420M}}}));

TEST_F(V4l2Memory, LentFramesOutliveStopAndCamera) {
  plug();
  startOrFail(lending());
  CapturedFrame first = frameOrFail();
  camera().stop();
  destroyCamera();
  expectPicture(first, 0);
  first = {};
  expectNothingLeft();
}

TEST_F(V4l2Memory, ADriverThatTakesNoneUsesItsOwnAndSaysWhy) {
  plug({.takesLentMemory = false});
  const StreamFormat format = startOrFail(lending());
  EXPECT_EQ(format.memory, FrameMemory::kExported);
  EXPECT_THAT(format.memoryNote, HasSubstr("takes no memory of others"));
  expectPicture(frameOrFail(), 0);
}

TEST_F(V4l2Memory, AnAllocatorThatRunsDryLeavesTheDriversOwn) {
  plug();
  const StreamFormat format = startOrFail(lending(3));
  EXPECT_EQ(format.memory, FrameMemory::kExported);
  EXPECT_THAT(format.memoryNote, HasSubstr("cannot allocate memory for frames"));
  expectPicture(frameOrFail(), 0);
  destroyCamera();
  expectNothingLeft();
}

TEST_F(V4l2Memory, PicturesThatAreDecodedAreTheProcessors) {
  support::FakeVideo video{.formats = {{.fourcc = V4L2_PIX_FMT_MJPEG}}};
  plug(std::move(video));
  const StreamFormat format = startOrFail(lending());
  EXPECT_EQ(format.memory, FrameMemory::kProcessor);
  EXPECT_THAT(format.memoryNote, IsEmpty());
}

TEST_F(V4l2Memory, TheColourDescriptionIsWhole) {
  plug({.colorspace = V4L2_COLORSPACE_REC709});
  const ColorEncoding hd = startOrFail().frame.encoding;
  EXPECT_EQ(hd.primaries, ColorPrimaries::kBt709);
  EXPECT_EQ(hd.transfer, ColorTransfer::kBt709);
  camera().stop();
  plug({.colorspace = V4L2_COLORSPACE_SMPTE170M});
  EXPECT_EQ(startOrFail().frame.encoding.primaries, ColorPrimaries::kSmpte170m);
}

}  // namespace
}  // namespace pleinair::hal::v4l2
