#include "hal/media/motion_jpeg.h"
#include "tests/support/test_jpegs.h"
#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using support::testJpeg;

class V4l2Jpeg : public FakeCamera {
 protected:
  support::FakeVideo& plugJpeg(std::map<std::uint64_t, support::FakeFrame> frames = {}) {
    return plug({.formats = {{.fourcc = V4L2_PIX_FMT_MJPEG, .sizes = {support::kTestJpegSize}}},
                 .jpeg = testJpeg("j420.jpg"),
                 .frames = std::move(frames)});
  }
};

/// The mean of a plane's samples.
double meanOf(const ImageView& view, int plane) {
  double sum = 0;
  const int rows = planeRows(view.format.pixelFormat, plane, view.format.size.height);
  for (int y = 0; y < rows; ++y) {
    for (const std::uint8_t sample : view.row(plane, y)) sum += sample;
  }
  return sum / (rows * static_cast<double>(view.row(plane, 0).size()));
}

TEST(MotionJpeg, ComesAsI420WhateverItsChroma) {
  const std::vector<std::uint8_t> reference = testJpeg("j420.jpg");
  const auto expected = libav::decodeMotionJpeg(reference, "test");
  ASSERT_TRUE(expected) << expected.error().message();
  for (const char* name : {"j420.jpg", "j422.jpg", "j444.jpg"}) {
    const auto picture = libav::decodeMotionJpeg(testJpeg(name), "test");
    ASSERT_TRUE(picture) << name << picture.error().message();
    EXPECT_EQ(picture->view.format, expected->view.format) << name;
    EXPECT_TRUE(picture->view.isComplete()) << name;
    for (int plane = 0; plane < 3; ++plane) {
      EXPECT_NEAR(meanOf(picture->view, plane), meanOf(expected->view, plane), 2) << name << plane;
    }
  }
  EXPECT_EQ(expected->view.format,
            (FrameFormat{.pixelFormat = PixelFormat::kI420,
                         .size = support::kTestJpegSize,
                         .encoding = {.matrix = ColorMatrix::kBt601, .range = ColorRange::kFull}}));
}

TEST(MotionJpeg, OfGreyHasNeutralChroma) {
  const auto picture = libav::decodeMotionJpeg(testJpeg("one_component.jpg"), "test");
  ASSERT_TRUE(picture) << picture.error().message();
  ASSERT_EQ(picture->view.format.pixelFormat, PixelFormat::kI420);
  EXPECT_EQ(meanOf(picture->view, 1), 128);
  EXPECT_EQ(meanOf(picture->view, 2), 128);
  EXPECT_GT(meanOf(picture->view, 0), 0);
}

TEST(MotionJpeg, RefusesWhatIsNone) {
  EXPECT_EQ(libav::decodeMotionJpeg({}, "test").error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(libav::decodeMotionJpeg(testJpeg("rgb.png"), "test").error().message(),
            "test: gives no JPEG");
  EXPECT_FALSE(libav::decodeMotionJpeg(testJpeg("cut.jpg"), "test"));
}

TEST_F(V4l2Jpeg, IsDecoded) {
  plugJpeg();
  const StreamFormat format = startOrFail();
  EXPECT_EQ(format.frame.pixelFormat, PixelFormat::kI420);
  EXPECT_EQ(format.frame.encoding.range, ColorRange::kFull);
  const CapturedFrame frame = frameOrFail();
  EXPECT_EQ(frame.image.format, format.frame);
  EXPECT_EQ(frame.health, FrameHealth::kValid);
  EXPECT_EQ(frame.dmaBufs[0].fd, -1);
  const auto expected = libav::decodeMotionJpeg(testJpeg("j420.jpg"), "test");
  for (int y = 0; y < format.frame.size.height; ++y) {
    EXPECT_THAT(frame.image.map().view().row(0, y),
                testing::ElementsAreArray(expected->view.row(0, y)));
  }
}

TEST_F(V4l2Jpeg, ThatIsBrokenIsACorruptFrameWithTheLastSoundPicture) {
  std::vector<std::uint8_t> holed = testJpeg("j420.jpg");
  holed.erase(holed.end() - 42, holed.end() - 2);  // its end marker stays
  plugJpeg({{1, {.jpeg = testJpeg("cut.jpg")}},
            {2, {.jpeg = std::vector<std::uint8_t>{}}},
            {3, {.jpeg = holed}},
            {4, {.addedFlags = V4L2_BUF_FLAG_ERROR}},
            {5, {.jpeg = testJpeg("exif6.jpg")}}});
  startOrFail();
  const CapturedFrame sound = frameOrFail();
  for (int i = 1; i <= 4; ++i) {
    const CapturedFrame broken = frameOrFail();
    EXPECT_EQ(broken.health, FrameHealth::kCorrupt) << i;
    EXPECT_EQ(broken.sequence, static_cast<unsigned>(i));
    EXPECT_EQ(broken.image.map().view().planes[0].bytes.data(),
              sound.image.map().view().planes[0].bytes.data());
  }
  EXPECT_EQ(frameOrFail().health, FrameHealth::kValid) << "as stored, not turned";
}

TEST_F(V4l2Jpeg, OfAnotherSizeThanAgreedIsCorrupt) {
  plug({.formats = {{.fourcc = V4L2_PIX_FMT_MJPEG, .sizes = {FrameSize{64, 48}}}},
        .jpeg = testJpeg("j420.jpg")});
  const StreamFormat format = startOrFail();
  const CapturedFrame frame = frameOrFail();
  EXPECT_EQ(frame.health, FrameHealth::kCorrupt);
  EXPECT_EQ(frame.image.format, format.frame);
  EXPECT_TRUE(frame.image.isComplete());
  EXPECT_EQ(meanOf(frame.image.map().view(), 0), 0) << "black: there is no valid image yet";
  EXPECT_EQ(meanOf(frame.image.map().view(), 1), 128);
}

TEST_F(V4l2Jpeg, HoldsNoBufferOfTheDriver) {
  plugJpeg().mostBuffers = 2;
  startOrFail();
  std::vector<CapturedFrame> held;
  for (unsigned i = 0; i < 20; ++i) {
    held.push_back(frameOrFail());
    EXPECT_EQ(held.back().sequence, i);
  }
}

}  // namespace
}  // namespace pleinair::hal::v4l2
