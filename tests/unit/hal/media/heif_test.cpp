#include <cstdint>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <libheif/heif.h>

#include "hal/media/frame_pixels.h"
#include "hal/media/picture_decoder.h"

namespace pleinair::hal::libav {
namespace {

constexpr FrameSize kHeifSize{64, 48};

/// Left half red, right half blue; empty where libheif has no encoder.
std::vector<std::uint8_t> heic(heif_compression_format coding) {
  const std::unique_ptr<heif_context, decltype(&heif_context_free)> context(heif_context_alloc(),
                                                                            heif_context_free);
  heif_encoder* encoder = nullptr;
  if (heif_context_get_encoder_for_format(context.get(), coding, &encoder).code != heif_error_Ok) {
    return {};
  }
  heif_image* image = nullptr;
  heif_image_create(kHeifSize.width, kHeifSize.height, heif_colorspace_RGB,
                    heif_chroma_interleaved_RGB, &image);
  heif_image_add_plane(image, heif_channel_interleaved, kHeifSize.width, kHeifSize.height, 8);
  int stride = 0;
  std::uint8_t* const plane = heif_image_get_plane(image, heif_channel_interleaved, &stride);
  for (int y = 0; y < kHeifSize.height; ++y) {
    for (int x = 0; x < kHeifSize.width; ++x) {
      const bool isLeft = x < kHeifSize.width / 2;
      std::uint8_t* const pixel = plane + std::ptrdiff_t{y} * stride + std::ptrdiff_t{3} * x;
      pixel[0] = isLeft ? 220 : 20;
      pixel[1] = 30;
      pixel[2] = isLeft ? 20 : 220;
    }
  }
  heif_encoder_set_lossy_quality(encoder, 90);
  heif_context_encode_image(context.get(), image, encoder, nullptr, nullptr);
  std::vector<std::uint8_t> bytes;
  heif_writer writer{.writer_api_version = 1,
                     .write = [](heif_context*, const void* data, size_t size, void* user) {
                       const auto* first = static_cast<const std::uint8_t*>(data);
                       static_cast<std::vector<std::uint8_t>*>(user)->assign(first, first + size);
                       return heif_error{heif_error_Ok, heif_suberror_Unspecified, ""};
                     }};
  heif_context_write(context.get(), &writer, &bytes);
  heif_image_release(image);
  heif_encoder_release(encoder);
  return bytes;
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

INSTANTIATE_TEST_SUITE_P(Codings, Heif,
                         testing::Values(heif_compression_HEVC, heif_compression_AV1));

}  // namespace
}  // namespace pleinair::hal::libav
