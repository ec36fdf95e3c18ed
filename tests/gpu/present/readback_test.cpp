#include "pipeline/present/readback.h"

#include <array>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "hal/error.h"
#include "pipeline/gpu/frames/frame_upload.h"
#include "pipeline/present/present_shaders.h"
#include "tests/oracles/frame_oracle.h"
#include "tests/support/gl_pictures.h"
#include "tests/support/gl_test.h"

namespace pleinair::present {
namespace {

using hal::ColorEncoding;
using hal::ColorMatrix;
using hal::ColorRange;
using hal::FrameFormat;
using hal::FrameSize;
using hal::PixelFormat;
using support::GlTest;
using support::largestError;
using support::randomImage;
using support::textureOf;
using support::wavyImage;

constexpr std::array kSizes{FrameSize{1, 1}, FrameSize{1, 6}, FrameSize{6, 1}, FrameSize{2, 2},
                            FrameSize{5, 3}, FrameSize{7, 5}, FrameSize{9, 4}, FrameSize{64, 48}};

std::string named(FrameSize size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

class ReadbackTest : public GlTest {
 protected:
  ReadbackTest() { library_.add(gpu::presentShaders()); }

  /// One picture through a reader.
  hal::Image read(const hal::Image& rgb, FrameFormat format) {
    Readback reader(library_, format);
    reader.submit(textureOf(rgb.view()));
    hal::Image image;
    EXPECT_TRUE(hal::orThrow(reader.wait(image)));
    EXPECT_EQ(image.format(), format);
    return image;
  }

  /// A 4×4 picture of one grey, recognised by it.
  static gpu::Texture grey(std::uint8_t value) {
    hal::Image image({.pixelFormat = PixelFormat::kRgb8, .size = {4, 4}});
    std::ranges::fill(image.plane(0), value);
    return textureOf(image.view());
  }

  gpu::ShaderLibrary library_;
};

using Case = std::tuple<PixelFormat, ColorMatrix, ColorRange>;
class ReadbackFormatTest : public ReadbackTest, public testing::WithParamInterface<Case> {
 protected:
  static FrameFormat format(FrameSize size) {
    const auto [pixelFormat, matrix, range] = GetParam();
    return {
        .pixelFormat = pixelFormat, .size = size, .encoding = {.matrix = matrix, .range = range}};
  }
};

TEST_P(ReadbackFormatTest, PacksAsTheStandardsSay) {
  for (const FrameSize size : kSizes) {
    const hal::Image rgb = randomImage({.pixelFormat = PixelFormat::kRgb8, .size = size});
    hal::Image image = read(rgb, format(size));
    hal::Image expected = oracles::packed(oracles::rgbOf(rgb.view()), format(size));
    // Where the exact value lies halfway, rounding may go either way.
    EXPECT_LE(largestError(image, expected), isYCbCr(format(size).pixelFormat) ? 1 : 0)
        << named(size);
  }
}

TEST_P(ReadbackFormatTest, ComesBackThroughTheUploader) {
  const FrameSize size{66, 50};
  const hal::Image rgb = wavyImage(size);
  hal::Image image = read(rgb, format(size));
  gpu::FrameUploader uploader{library_};
  hal::Image back = support::readRgba8(uploader.upload(image.view(), size));
  double worst = 0.0;
  const oracles::Picture expected = oracles::rgbOf(rgb.view());
  for (int y = 2; y < size.height - 2; ++y) {  // a border's chroma has neighbours on one side only
    for (int x = 2; x < size.width - 2; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double is = back.row(0, y)[static_cast<std::size_t>(4 * x + c)];
        worst = std::max(worst, std::abs(is - 255.0 * expected.clampedAt(x, y)[c]));
      }
    }
  }
  // Chroma of waves this slow survives being halved (5); sited wrongly it costs 7 and more.
  EXPECT_LE(worst, 6.0);
}

std::string caseName(const testing::TestParamInfo<Case>& info) {
  return std::string(toString(std::get<0>(info.param))) +
         (std::get<1>(info.param) == ColorMatrix::kBt601 ? "_601" : "_709") +
         (std::get<2>(info.param) == ColorRange::kLimited ? "_limited" : "_full");
}

INSTANTIATE_TEST_SUITE_P(Ycbcr, ReadbackFormatTest,
                         testing::Combine(testing::Values(PixelFormat::kNv12, PixelFormat::kI420,
                                                          PixelFormat::kYuyv),
                                          testing::Values(ColorMatrix::kBt601, ColorMatrix::kBt709),
                                          testing::Values(ColorRange::kLimited, ColorRange::kFull)),
                         caseName);
INSTANTIATE_TEST_SUITE_P(Rgb, ReadbackFormatTest,
                         testing::Combine(testing::Values(PixelFormat::kRgb8, PixelFormat::kRgba8),
                                          testing::Values(ColorMatrix::kBt601),
                                          testing::Values(ColorRange::kLimited)),
                         caseName);

// Grey is full-range luma whatever encoding the format happens to carry.
TEST_F(ReadbackTest, MakesGreyOfFullRange) {
  for (const FrameSize size : kSizes) {
    const hal::Image rgb = randomImage({.pixelFormat = PixelFormat::kRgb8, .size = size});
    const FrameFormat format{.pixelFormat = PixelFormat::kGrey8, .size = size};
    hal::Image image = read(rgb, format);
    hal::Image expected = oracles::packed(oracles::rgbOf(rgb.view()), format);
    EXPECT_LE(largestError(image, expected), 1) << named(size);
  }
  hal::Image white({.pixelFormat = PixelFormat::kRgb8, .size = {4, 4}});
  std::ranges::fill(white.plane(0), std::uint8_t{255});
  EXPECT_EQ(read(white, {.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}}).plane(0)[5], 255);
}

TEST_F(ReadbackTest, ScalesToItsFormat) {
  const hal::Image rgb = randomImage({.pixelFormat = PixelFormat::kRgb8, .size = {64, 40}});
  const FrameFormat format{.pixelFormat = PixelFormat::kRgb8, .size = {32, 20}};
  hal::Image image = read(rgb, format);
  hal::Image expected =
      oracles::packed(oracles::resampledByArea(oracles::rgbOf(rgb.view()), format.size), format);
  EXPECT_LE(largestError(image, expected), 1);
}

TEST_F(ReadbackTest, HandsPicturesOutInTheirOrder) {
  Readback reader(library_, {.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}}, 3);
  std::uint8_t submitted = 0;
  std::uint8_t taken = 0;
  hal::Image image;
  for (int round = 0; round < 4; ++round) {  // the ring turns over
    while (reader.hasRoom()) reader.submit(grey(submitted++));
    for (int i = 0; i < 2; ++i) {
      ASSERT_TRUE(hal::orThrow(reader.wait(image)));
      EXPECT_EQ(image.plane(0)[0], taken++);
    }
  }
  while (hal::orThrow(reader.wait(image))) EXPECT_EQ(image.plane(0)[0], taken++);
  EXPECT_EQ(taken, submitted);
  EXPECT_EQ(submitted, 9);
}

TEST_F(ReadbackTest, PacksWithinOneAndAHalfTimesTheHeight) {
  for (const PixelFormat format : {PixelFormat::kI420, PixelFormat::kNv12}) {
    EXPECT_EQ(Readback::packedSize({format, {3840, 2160}}), (FrameSize{960, 3240}));
    EXPECT_EQ(Readback::packedSize({format, {1, 1}}).height, 2);
  }
  EXPECT_EQ(Readback::packedSize({PixelFormat::kRgb8, {5, 3}}), (FrameSize{4, 3}));
}

TEST_F(ReadbackTest, WarmsUpWithoutATrace) {
  Readback reader(library_, {.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}}, 2);
  reader.warmUp({6, 5});
  EXPECT_TRUE(reader.isEmpty());
  reader.submit(grey(7));
  reader.submit(grey(8));
  EXPECT_FALSE(reader.hasRoom());
  hal::Image image;
  for (const int expected : {7, 8}) {
    ASSERT_TRUE(hal::orThrow(reader.wait(image)));
    EXPECT_EQ(image.plane(0)[15], expected);
  }
}

TEST_F(ReadbackTest, TurnsPicturesClockwiseToTheBit) {
  const hal::FrameFormat upright{.pixelFormat = PixelFormat::kRgba8, .size = {5, 3}};
  hal::Image picture(upright);
  for (std::size_t i = 0; i < picture.plane(0).size(); ++i) {
    picture.plane(0)[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 255 : 7 * i);
  }
  const gpu::Texture texture = textureOf(picture.view());
  const auto at = [](const hal::Image& image, int x, int y) {
    return image.view().row(0, y).subspan(static_cast<std::size_t>(4 * x), 4);
  };
  for (int turns = 0; turns < 4; ++turns) {
    hal::FrameFormat format = upright;
    if (turns % 2 != 0) std::swap(format.size.width, format.size.height);
    Readback reader(library_, format, 1, {}, turns);
    reader.submit(texture);
    hal::Image turned;
    ASSERT_TRUE(hal::orThrow(reader.wait(turned)));
    for (int y = 0; y < upright.size.height; ++y) {
      for (int x = 0; x < upright.size.width; ++x) {
        // Where a turn takes the pixel: the upper left corner goes to the upper right one.
        int toX = x, toY = y, height = upright.size.height, width = upright.size.width;
        for (int i = 0; i < turns; ++i) {
          toX = std::exchange(toY, toX);
          toX = height - 1 - toX;
          std::swap(width, height);
        }
        EXPECT_TRUE(std::ranges::equal(at(turned, toX, toY), at(picture, x, y)))
            << turns << " turns, " << x << ", " << y;
      }
    }
  }
}

TEST_F(ReadbackTest, SaysWhetherThereIsRoom) {
  Readback reader(library_, {.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}}, 2);
  EXPECT_TRUE(reader.isEmpty());
  EXPECT_TRUE(reader.hasRoom());
  reader.submit(grey(1));
  EXPECT_FALSE(reader.isEmpty());
  EXPECT_TRUE(reader.hasRoom());
  reader.submit(grey(2));
  EXPECT_FALSE(reader.hasRoom());
  hal::Image image;
  EXPECT_TRUE(hal::orThrow(reader.wait(image)));
  EXPECT_TRUE(reader.hasRoom());
}

TEST_F(ReadbackTest, TakesNothingWhereNothingIsAndWithoutWaitingOnlyWhatIsReady) {
  Readback reader(library_, {.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}});
  hal::Image image;
  EXPECT_FALSE(hal::orThrow(reader.poll(image)));
  EXPECT_FALSE(hal::orThrow(reader.wait(image)));
  EXPECT_EQ(image.size(), FrameSize{});
  reader.submit(grey(9));
  EXPECT_TRUE(gpu::Fence::insert().wait());  // so the earlier one has, too
  EXPECT_TRUE(hal::orThrow(reader.poll(image)));
  EXPECT_EQ(image.plane(0)[15], 9);
  EXPECT_FALSE(hal::orThrow(reader.poll(image)));
}

TEST_F(ReadbackTest, KeepsTheMemoryOfTheImageItFills) {
  Readback reader(library_, {.pixelFormat = PixelFormat::kI420, .size = {8, 8}});
  hal::Image image(reader.format());
  const std::uint8_t* const memory = image.plane(0).data();
  reader.submit(grey(9));
  ASSERT_TRUE(hal::orThrow(reader.wait(image)));
  EXPECT_EQ(image.plane(0).data(), memory);
}

using ReadbackDeathTest = ReadbackTest;

TEST_F(ReadbackDeathTest, RefusesMoreThanItsRingHoldsAndBayer) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  Readback reader(library_, {.pixelFormat = PixelFormat::kGrey8, .size = {4, 4}}, 1);
  const gpu::Texture picture = grey(1);
  reader.submit(picture);
  EXPECT_DEATH(reader.submit(picture), "hasRoom");
  const FrameFormat bayer{.pixelFormat = PixelFormat::kBayerRggb8, .size = {4, 4}};
  EXPECT_DEATH(Readback(library_, bayer), "no output takes Bayer");
}

}  // namespace
}  // namespace pleinair::present
