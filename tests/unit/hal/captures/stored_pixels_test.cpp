#include "hal/captures/stored_pixels.h"

#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace pleinair::hal::captures {
namespace {

Image noise(FrameFormat format) {
  Image image(format);
  std::mt19937 random(static_cast<unsigned>(format.size.width));
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    for (std::uint8_t& byte : image.plane(plane)) byte = static_cast<std::uint8_t>(random());
  }
  return image;
}

libav::Frame frameFor(const FrameFormat& format) {
  libav::Frame frame = libav::makeFrame();
  frame->format = storedFormat(format.pixelFormat);
  frame->width = format.size.width;
  frame->height = format.size.height;
  EXPECT_GE(av_frame_get_buffer(frame.get(), 0), 0);
  return frame;
}

TEST(StoredPixels, AreRestoredToTheBit) {
  for (const PixelFormat pixels :
       {PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kRgba8, PixelFormat::kYuyv,
        PixelFormat::kNv12, PixelFormat::kI420, PixelFormat::kBayerRggb8, PixelFormat::kBayerGrbg8,
        PixelFormat::kBayerGbrg8, PixelFormat::kBayerBggr8}) {
    for (const FrameSize size : {FrameSize{8, 6}, FrameSize{33, 17}, FrameSize{1, 1}}) {
      if (pixels == PixelFormat::kYuyv && size.width % 2 != 0) continue;  // see below
      const FrameFormat format{
          .pixelFormat = pixels,
          .size = size,
          .encoding = isYCbCr(pixels) ? ColorEncoding{ColorMatrix::kBt709, ColorRange::kFull}
                                      : ColorEncoding{}};
      Image original = noise(format);
      const libav::Frame frame = frameFor(format);
      store(original.view(), *frame);
      std::optional<Image> image = restored(*frame, pixels);
      ASSERT_TRUE(image) << toString(pixels);
      EXPECT_EQ(image->format(), format) << toString(pixels);
      for (int plane = 0; plane < planeCount(pixels); ++plane) {
        EXPECT_TRUE(std::ranges::equal(image->plane(plane), original.plane(plane)))
            << toString(pixels) << " " << size.width << "x" << size.height;
      }
    }
  }
}

TEST(StoredPixels, OfAnotherLayoutAreNotRestored) {
  const libav::Frame frame = frameFor({.pixelFormat = PixelFormat::kI420, .size = {8, 6}});
  EXPECT_FALSE(restored(*frame, PixelFormat::kRgb8));
  EXPECT_TRUE(restored(*frame, PixelFormat::kNv12));
}

TEST(StoredPixels, KnowEveryFormatByItsName) {
  for (int i = 0; i <= static_cast<int>(PixelFormat::kBayerBggr8); ++i) {
    const auto format = static_cast<PixelFormat>(i);
    EXPECT_EQ(pixelFormatNamed(toString(format)), format);
  }
  EXPECT_FALSE(pixelFormatNamed("nv21"));
}

}  // namespace
}  // namespace pleinair::hal::captures
