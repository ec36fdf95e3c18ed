#include "hal/media/picture_decoder.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pleinair::hal::libav {
namespace {

/// A TIFF as libav's encoder writes it: with the tags of a resolution, as most have.
std::vector<std::uint8_t> tiff(AVPixelFormat layout) {
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_TIFF);
  const auto encoder = owned<CodecContext>(avcodec_alloc_context3(codec));
  encoder->width = 24;
  encoder->height = 16;
  encoder->pix_fmt = layout;
  encoder->time_base = {1, 1};
  if (avcodec_open2(encoder.get(), codec, nullptr) < 0) throw std::bad_alloc();
  Frame frame = makeFrame();
  frame->format = layout;
  frame->width = 24;
  frame->height = 16;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  for (int y = 0; y < 16; ++y) {
    std::fill_n(frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0], 24 * 3,
                static_cast<std::uint8_t>(10 * y));
  }
  const Packet packet = makePacket();
  avcodec_send_frame(encoder.get(), frame.get());
  avcodec_receive_packet(encoder.get(), packet.get());
  return {packet->data, packet->data + packet->size};
}

TEST(PictureDecoder, ReadsTiffWithTagsThatItDoesNotUse) {
  const auto picture = decodePicture(tiff(AV_PIX_FMT_RGB24), "a.tif");
  ASSERT_TRUE(picture) << picture.error().message();
  EXPECT_EQ((*picture)->width, 24);
  for (int y = 0; y < 16; ++y) {
    EXPECT_EQ((*picture)->data[0][std::ptrdiff_t{y} * (*picture)->linesize[0]], 10 * y);
  }
}

TEST(PictureDecoder, RefusesTiffThatBreaksOff) {
  std::vector<std::uint8_t> bytes = tiff(AV_PIX_FMT_RGB24);
  bytes.resize(bytes.size() / 2);
  const auto picture = decodePicture(bytes, "a.tif");
  ASSERT_FALSE(picture);
  EXPECT_EQ(picture.error().kind, ErrorKind::kInvalidInput);
}

TEST(PictureDecoder, SaysThatBrokenHeicIsBroken) {
  std::vector<std::uint8_t> bytes{0, 0, 0, 16, 'f', 't', 'y', 'p', 'h', 'e', 'i', 'c', 0, 0, 0, 0};
  const auto picture = decodePicture(bytes, "a.heic");
  ASSERT_FALSE(picture);
  EXPECT_THAT(picture.error().message(),
              testing::AnyOf(testing::HasSubstr("is a broken picture"),
                             testing::HasSubstr("this build has no libheif")));
}

}  // namespace
}  // namespace pleinair::hal::libav
