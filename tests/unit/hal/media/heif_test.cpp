#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <libheif/heif.h>

#include "hal/media/frame_pixels.h"
#include "hal/media/picture_decoder.h"
#include "hal/media/srgb_profile.h"

namespace pleinair::hal::libav {
namespace {

constexpr FrameSize kHeifSize{64, 48};

/// Encodes an interleaved picture whose rows `draw` fills; empty where libheif has no encoder for
/// it.
std::vector<std::uint8_t> encoded(heif_compression_format coding, heif_chroma chroma, int depth,
                                  const std::function<void(std::uint8_t* row)>& draw,
                                  std::span<const std::uint8_t> profile = {}) {
  const std::unique_ptr<heif_context, decltype(&heif_context_free)> context(heif_context_alloc(),
                                                                            heif_context_free);
  heif_encoder* encoder = nullptr;
  if (heif_context_get_encoder_for_format(context.get(), coding, &encoder).code != heif_error_Ok) {
    return {};
  }
  heif_image* image = nullptr;
  heif_image_create(kHeifSize.width, kHeifSize.height, heif_colorspace_RGB, chroma, &image);
  heif_image_add_plane(image, heif_channel_interleaved, kHeifSize.width, kHeifSize.height, depth);
  int stride = 0;
  std::uint8_t* const plane = heif_image_get_plane(image, heif_channel_interleaved, &stride);
  for (int y = 0; y < kHeifSize.height; ++y) draw(plane + std::ptrdiff_t{y} * stride);
  if (!profile.empty()) {
    heif_image_set_raw_color_profile(image, "prof", profile.data(), profile.size());
  }
  heif_encoder_set_lossy_quality(encoder, 90);
  const heif_error status =
      heif_context_encode_image(context.get(), image, encoder, nullptr, nullptr);
  std::vector<std::uint8_t> bytes;
  heif_writer writer{.writer_api_version = 1,
                     .write = [](heif_context*, const void* data, size_t size, void* user) {
                       const auto* first = static_cast<const std::uint8_t*>(data);
                       static_cast<std::vector<std::uint8_t>*>(user)->assign(first, first + size);
                       return heif_error{heif_error_Ok, heif_suberror_Unspecified, ""};
                     }};
  if (status.code == heif_error_Ok) heif_context_write(context.get(), &writer, &bytes);
  heif_image_release(image);
  heif_encoder_release(encoder);
  return bytes;
}

/// Left half red, right half blue.
std::vector<std::uint8_t> heic(heif_compression_format coding) {
  return encoded(coding, heif_chroma_interleaved_RGB, 8, [](std::uint8_t* row) {
    for (int x = 0; x < kHeifSize.width; ++x) {
      const bool isLeft = x < kHeifSize.width / 2;
      std::uint8_t* const pixel = row + std::ptrdiff_t{3} * x;
      pixel[0] = isLeft ? 220 : 20;
      pixel[1] = 30;
      pixel[2] = isLeft ? 20 : 220;
    }
  });
}

/// Of 10 bits: dark, and transparent in its right half.
std::vector<std::uint8_t> deepWithAlpha(heif_compression_format coding) {
  return encoded(coding, heif_chroma_interleaved_RRGGBBAA_LE, 10, [](std::uint8_t* row) {
    for (int x = 0; x < kHeifSize.width; ++x) {
      constexpr int kDark = 160;
      const bool isLeft = x < kHeifSize.width / 2;
      for (int c = 0; c < 4; ++c) {
        const int sample = c < 3 ? kDark : isLeft ? 1023 : 0;
        *row++ = static_cast<std::uint8_t>(sample & 0xFF);
        *row++ = static_cast<std::uint8_t>(sample >> 8);
      }
    }
  });
}

class Heif : public testing::TestWithParam<heif_compression_format> {};

TEST_P(Heif, IsReadAsAPicture) {
  const std::vector<std::uint8_t> bytes = heic(GetParam());
  if (bytes.empty()) GTEST_SKIP() << "this libheif cannot encode it";
  const auto frame = decodePicture(bytes, "a.heic");
  ASSERT_TRUE(frame) << frame.error().message();
  const auto picture = lendPicture(*frame);
  ASSERT_TRUE(picture) << picture.error().message();
  ASSERT_EQ(picture->view.format.size, kHeifSize);
  const auto row = picture->view.row(0, 20);
  EXPECT_NEAR(row[3 * 10], 220, 12);
  EXPECT_NEAR(row[3 * 10 + 2], 20, 12);
  EXPECT_NEAR(row[3 * 54], 20, 12);
  EXPECT_NEAR(row[3 * 54 + 2], 220, 12);
}

TEST_P(Heif, IsRefusedWhereItBreaksOff) {
  std::vector<std::uint8_t> bytes = heic(GetParam());
  if (bytes.empty()) GTEST_SKIP() << "this libheif cannot encode it";
  bytes.resize(bytes.size() - 40);
  EXPECT_FALSE(decodePicture(bytes, "a.heic"));
}

TEST_P(Heif, OfMoreThanEightBitsKeepsItsAlpha) {
  const std::vector<std::uint8_t> bytes = deepWithAlpha(GetParam());
  if (bytes.empty()) GTEST_SKIP() << "this libheif cannot encode it";
  const auto frame = decodePicture(bytes, "a.avif");
  ASSERT_TRUE(frame) << frame.error().message();
  const auto picture = lendPicture(*frame);
  ASSERT_TRUE(picture) << picture.error().message();
  const auto row = picture->view.row(0, 20);
  EXPECT_NEAR(row[3 * 10], 40, 8);
  EXPECT_GT(row[3 * 54], 245) << "over white, where it is transparent";
}

TEST_P(Heif, CarriesItsProfileAlong) {
  const std::vector<std::uint8_t> bytes = encoded(
      GetParam(), heif_chroma_interleaved_RGB, 8,
      [](std::uint8_t* row) { std::fill_n(row, 3 * kHeifSize.width, std::uint8_t{90}); },
      srgbProfile());
  if (bytes.empty()) GTEST_SKIP() << "this libheif cannot encode it";
  const auto frame = decodePicture(bytes, "a.heic");
  ASSERT_TRUE(frame) << frame.error().message();
  const AVFrameSideData* const side =
      av_frame_get_side_data(frame->get(), AV_FRAME_DATA_ICC_PROFILE);
  ASSERT_NE(side, nullptr);
  EXPECT_TRUE(std::ranges::equal(std::span(side->data, side->size), srgbProfile()));
}

INSTANTIATE_TEST_SUITE_P(Codings, Heif,
                         testing::Values(heif_compression_HEVC, heif_compression_AV1));

}  // namespace
}  // namespace pleinair::hal::libav
