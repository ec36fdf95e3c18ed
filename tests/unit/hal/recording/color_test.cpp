// Known colours survive a movie, and each kind of picture.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/media/picture_file.h"
#include "hal/media/png_file.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using Rgb = std::array<double, 3>;
using YCbCr = std::array<double, 3>;

struct Luma {
  double red;
  double blue;
};
Luma lumaOf(ColorMatrix matrix) {
  return matrix == ColorMatrix::kBt709 ? Luma{0.2126, 0.0722} : Luma{0.299, 0.114};
}

/// ITU-R BT.601 and BT.709, 8-bit; both sides 0..255.
YCbCr encode(const Rgb& rgb, ColorEncoding encoding) {
  const Luma k = lumaOf(encoding.matrix);
  const double y = k.red * rgb[0] + (1 - k.red - k.blue) * rgb[1] + k.blue * rgb[2];
  const double cb = (rgb[2] - y) / (2 * (1 - k.blue));
  const double cr = (rgb[0] - y) / (2 * (1 - k.red));
  if (encoding.range == ColorRange::kFull) return {y, cb + 128, cr + 128};
  return {16 + y * 219 / 255, 128 + cb * 224 / 255, 128 + cr * 224 / 255};
}

Rgb decode(const YCbCr& value, ColorEncoding encoding) {
  const Luma k = lumaOf(encoding.matrix);
  const bool full = encoding.range == ColorRange::kFull;
  const double y = full ? value[0] : (value[0] - 16) * 255 / 219;
  const double cb = (value[1] - 128) * (full ? 1 : 255.0 / 224);
  const double cr = (value[2] - 128) * (full ? 1 : 255.0 / 224);
  const double red = y + 2 * (1 - k.red) * cr;
  const double blue = y + 2 * (1 - k.blue) * cb;
  return {red, (y - k.red * red - k.blue * blue) / (1 - k.red - k.blue), blue};
}

constexpr std::array<Rgb, 6> kColors = {
    {{200, 40, 40}, {40, 180, 60}, {50, 60, 190}, {128, 128, 128}, {250, 245, 240}, {10, 12, 8}}};

Image flatPicture(const Rgb& rgb, FrameFormat format) {
  Image image(format);
  const YCbCr value = encode(rgb, format.encoding);
  for (std::size_t plane = 0; plane < 3; ++plane) {
    for (std::uint8_t& byte : image.plane(static_cast<int>(plane))) {
      byte = static_cast<std::uint8_t>(std::lround(value[plane]));
    }
  }
  return image;
}

struct MovieCase {
  std::string file;
  FrameSize size;
  ColorMatrix matrix;
};
class MovieColors : public testing::TestWithParam<MovieCase> {};

TEST_P(MovieColors, ComeBackWithTheirEncoding) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / GetParam().file;
  const auto output = orThrow(openFileOutput(path));
  const FrameFormat format = orThrow(output->start({.size = GetParam().size})).frame;
  EXPECT_EQ(format.encoding.matrix, GetParam().matrix);
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    const Image picture = flatPicture(kColors[i], format);
    orThrow(output->write(picture.view(), std::chrono::milliseconds(40) * i));
  }
  orThrow(output->finish());

  const Result<support::Played> played = support::play(path);
  ASSERT_TRUE(played) << played.error().message();
  ASSERT_EQ(played->frames.size(), kColors.size());
  EXPECT_EQ(played->format.frame.encoding, format.encoding);
  for (std::size_t i = 0; i < kColors.size(); ++i) {
    const ImageView view = played->frames[i].image.map().view();
    const YCbCr value{double(view.planes[0].bytes[0]), double(view.planes[1].bytes[0]),
                      double(view.planes[2].bytes[0])};
    const Rgb rgb = decode(value, view.format.encoding);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rgb[c], kColors[i][c], 4.0) << i << " " << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, MovieColors,
                         testing::Values(MovieCase{"sd.mp4", {64, 48}, ColorMatrix::kBt601},
                                         MovieCase{"hd.mp4", {64, 720}, ColorMatrix::kBt709},
                                         MovieCase{"sd.mkv", {64, 48}, ColorMatrix::kBt601},
                                         MovieCase{"hd.mkv", {64, 720}, ColorMatrix::kBt709},
                                         MovieCase{"sd.y4m", {33, 17}, ColorMatrix::kBt601},
                                         MovieCase{"hd.y4m", {64, 720}, ColorMatrix::kBt709}),
                         [](const auto& kind) {
                           std::string name = kind.param.file;
                           name[2] = '_';
                           return name;
                         });

TEST(H264Movie, RepeatsTheLastColumnAndRowOfOddSizes) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "odd.mp4";
  const auto output = orThrow(openFileOutput(path));
  const FrameFormat format = orThrow(output->start({.size = {1, 3}})).frame;
  ASSERT_EQ(format.size, (FrameSize{1, 3}));
  const Image picture = flatPicture(kColors[0], format);
  orThrow(output->write(picture.view(), Duration(0)));
  orThrow(output->finish());
  const Result<support::Played> played = support::play(path);
  ASSERT_TRUE(played) << played.error().message();
  const ImageView view = played->frames.at(0).image.map().view();
  ASSERT_EQ(view.format.size, (FrameSize{2, 4}));
  for (int y = 0; y < 4; ++y) {
    for (const std::uint8_t luma : view.row(0, y)) {
      EXPECT_NEAR(luma, encode(kColors[0], format.encoding)[0], 3.0);
    }
  }
}

TEST(Pictures, RgbGreyAndAlphaRoundTripThroughPng) {
  const support::TemporaryFolder folder;
  const auto path = folder.path() / "a.png";
  for (const PixelFormat format : {PixelFormat::kRgb8, PixelFormat::kGrey8}) {
    for (const FrameSize size : {FrameSize{1, 1}, FrameSize{17, 5}}) {
      const Image picture = support::testPicture({.pixelFormat = format, .size = size}, 3);
      ASSERT_TRUE(writePng(path, picture.view()));
      const Result<Image> back = readPicture(path);
      ASSERT_TRUE(back) << back.error().message();
      ASSERT_EQ(back->format().pixelFormat, format);
      ASSERT_EQ(back->size(), size);
      for (int y = 0; y < size.height; ++y) {
        EXPECT_TRUE(std::ranges::equal(back->view().row(0, y), picture.view().row(0, y)));
      }
    }
  }
  Image alpha({.pixelFormat = PixelFormat::kRgba8, .size = {3, 1}});
  const std::vector<std::uint8_t> pixels = {200, 100, 0, 255, 200, 100, 0, 0, 200, 100, 0, 51};
  std::ranges::copy(pixels, alpha.plane(0).begin());
  ASSERT_TRUE(writePng(path, alpha.view()));
  const Image onPaper = orThrow(readPicture(path));
  EXPECT_THAT(onPaper.view().row(0, 0),
              testing::ElementsAre(200, 100, 0, 255, 255, 255, 244, 224, 204));
}

TEST(Pictures, RefuseFormatsThatPngHasNot) {
  const support::TemporaryFolder folder;
  const Image picture({.pixelFormat = PixelFormat::kI420, .size = {4, 4}});
  const Result<void> written = writePng(folder.path() / "a.png", picture.view());
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().kind, ErrorKind::kUnsupported);
}

TEST(Pictures, ReadPnmAsItIs) {
  const support::TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& bytes) {
    std::ofstream(folder.path() / name, std::ios::binary) << bytes;
    return folder.path() / name;
  };
  const Image rgb = orThrow(readPicture(write("a.ppm", "P6\n# made by hand\n2 1\n255\nabcdef")));
  EXPECT_THAT(rgb.view().row(0, 0), testing::ElementsAre('a', 'b', 'c', 'd', 'e', 'f'));
  const Image grey = orThrow(readPicture(write("a.pgm", "P5 3 1 255\nxyz")));
  EXPECT_EQ(grey.format().pixelFormat, PixelFormat::kGrey8);
  // 16-bit grey is scaled, not truncated: 0, 0x8080, 0xFFFF.
  const Image deep = orThrow(
      readPicture(write("deep.pgm", std::string("P5 3 1 65535\n\0\0\x80\x80\xFF\xFF", 19))));
  EXPECT_THAT(deep.view().row(0, 0), testing::ElementsAre(0, 128, 255));
  for (const char* huge : {"P6 8193 1 255\n", "P6 8192 8192 255\n", "P5 99999999999 1 255\n"}) {
    const Result<Image> refused = readPicture(write("huge.ppm", huge));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::kUnsupported) << refused.error().message();
  }
}

TEST(Pictures, AreTheSameAsRgbWithinTheirCoding) {
  const std::filesystem::path photo =
      std::filesystem::path(PLEINAIR_SHARED_DATA) / "sequences/room_walk/IMG_1368.JPG";
  if (!std::filesystem::exists(photo)) GTEST_SKIP() << "test data is not here: " << photo;
  const Image stored = orThrow(readPicture(photo));
  ASSERT_EQ(stored.format().pixelFormat, PixelFormat::kI420);
  EXPECT_EQ(stored.format().encoding,
            (ColorEncoding{.matrix = ColorMatrix::kBt601, .range = ColorRange::kFull}));
  const Image rgb = orThrow(readPictureRgb(photo));
  ASSERT_EQ(rgb.format().pixelFormat, PixelFormat::kRgb8);
  // Compares the mean colour: chroma filters differ per pixel, but not on average.
  Rgb ours{};
  Rgb theirs{};
  const ImageView view = stored.view();
  for (int y = 0; y < stored.size().height; ++y) {
    const auto row = [&](int plane, int at) { return view.row(plane, at); };
    for (int x = 0; x < stored.size().width; ++x) {
      const auto at = static_cast<std::size_t>(x);
      const Rgb decoded = decode(
          {double(row(0, y)[at]), double(row(1, y / 2)[at / 2]), double(row(2, y / 2)[at / 2])},
          stored.format().encoding);
      for (std::size_t c = 0; c < 3; ++c) {
        ours[c] += std::clamp(decoded[c], 0.0, 255.0);
        theirs[c] += rgb.view().row(0, y)[3 * at + c];
      }
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(ours[c], theirs[c], 1.0 * static_cast<double>(stored.size().pixels())) << c;
  }
}

}  // namespace
}  // namespace pleinair::hal
