#include "pipeline/gpu/frames/frame_upload.h"

#include <array>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "tests/oracles/frame_oracle.h"
#include "tests/support/gl_pictures.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using hal::ColorMatrix;
using hal::ColorRange;
using hal::FrameSize;
using hal::PixelFormat;
using support::GlTest;
using support::largestError;
using support::PaddedImage;
using support::randomImage;
using support::readRgba8;

constexpr std::array kSizes{FrameSize{1, 1}, FrameSize{1, 6}, FrameSize{6, 1},
                            FrameSize{2, 2}, FrameSize{5, 3}, FrameSize{7, 5},
                            FrameSize{3, 2}, FrameSize{2, 7}, FrameSize{64, 48}};

// A byte of rounding; the rasteriser's 8-bit weights of interpolated chroma, times the
// matrix's 2.1.
constexpr double kYcbcrTolerance = 3.0;
constexpr double kRounding = 0.51;

std::string named(FrameSize size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

class FrameUploaderTest : public GlTest {
 protected:
  static double errorOf(FrameUploader& uploader, const hal::ImageView& image) {
    hal::Image back = readRgba8(uploader.upload(image, image.format.size));
    return largestError(back, oracles::rgbOf(image));
  }
};

using YcbcrCase = std::tuple<PixelFormat, ColorMatrix, ColorRange>;
class FrameUploaderYcbcrTest : public FrameUploaderTest,
                               public testing::WithParamInterface<YcbcrCase> {};

TEST_P(FrameUploaderYcbcrTest, ConvertsAsTheStandardsSay) {
  const auto [pixelFormat, matrix, range] = GetParam();
  FrameUploader uploader{ShaderLibrary{}};
  for (const FrameSize size : kSizes) {
    const hal::Image image = randomImage(
        {.pixelFormat = pixelFormat, .size = size, .encoding = {.matrix = matrix, .range = range}});
    EXPECT_LE(errorOf(uploader, image.view()), kYcbcrTolerance) << named(size);
  }
}

std::string ycbcrCaseName(const testing::TestParamInfo<YcbcrCase>& info) {
  return std::string(toString(std::get<0>(info.param))) +
         (std::get<1>(info.param) == ColorMatrix::kBt601 ? "_601" : "_709") +
         (std::get<2>(info.param) == ColorRange::kLimited ? "_limited" : "_full");
}

INSTANTIATE_TEST_SUITE_P(Formats, FrameUploaderYcbcrTest,
                         testing::Combine(testing::Values(PixelFormat::kNv12, PixelFormat::kI420,
                                                          PixelFormat::kYuyv),
                                          testing::Values(ColorMatrix::kBt601, ColorMatrix::kBt709),
                                          testing::Values(ColorRange::kLimited, ColorRange::kFull)),
                         ycbcrCaseName);

/// One luma, and chroma that is neutral in the left sample and coloured in the right.
hal::Image chromaStep(PixelFormat format, ColorRange range) {
  hal::Image image({.pixelFormat = format, .size = {4, 2}, .encoding = {.range = range}});
  if (format == PixelFormat::kYuyv) {
    for (int y = 0; y < 2; ++y) {
      std::ranges::copy(std::array<std::uint8_t, 8>{100, 128, 100, 128, 100, 128, 100, 168},
                        image.row(0, y).begin());
    }
    return image;
  }
  std::ranges::fill(image.plane(0), std::uint8_t{100});
  std::ranges::copy(std::array<std::uint8_t, 4>{128, 128, 128, 168}, image.plane(1).begin());
  return image;
}

// Written out by hand, apart from the oracle: red's share of the step at each of four columns.
TEST_F(FrameUploaderTest, SitesChromaLeftWhenLimitedAndBetweenWhenFull) {
  FrameUploader uploader{ShaderLibrary{}};
  for (const PixelFormat format : {PixelFormat::kNv12, PixelFormat::kYuyv}) {
    for (const ColorRange range : {ColorRange::kLimited, ColorRange::kFull}) {
      const bool limited = range == ColorRange::kLimited;
      const std::array<double, 4> share =
          limited ? std::array{0.0, 0.5, 1.0, 1.0} : std::array{0.0, 0.25, 0.75, 1.0};
      const double base = limited ? (100.0 - 16.0) * 255.0 / 219.0 : 100.0;
      const double step = 40.0 * 1.402 * (limited ? 255.0 / 224.0 : 1.0);
      const hal::Image image = chromaStep(format, range);
      hal::Image back = readRgba8(uploader.upload(image.view(), {4, 2}));
      for (std::size_t x = 0; x < 4; ++x) {
        EXPECT_NEAR(back.row(0, 0)[x * 4], base + share[x] * step, 1.5)
            << toString(format) << (limited ? " limited" : " full") << " column " << x;
      }
    }
  }
}

class FrameUploaderExactTest : public FrameUploaderTest,
                               public testing::WithParamInterface<PixelFormat> {};

TEST_P(FrameUploaderExactTest, ConvertsToTheByte) {
  FrameUploader uploader{ShaderLibrary{}};
  for (const FrameSize size : kSizes) {
    const hal::Image image = randomImage({.pixelFormat = GetParam(), .size = size});
    EXPECT_LE(errorOf(uploader, image.view()), kRounding) << named(size);
  }
}

std::string formatName(const testing::TestParamInfo<PixelFormat>& info) {
  std::string name(toString(info.param));
  std::ranges::replace(name, '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Formats, FrameUploaderExactTest,
                         testing::Values(PixelFormat::kGrey8, PixelFormat::kRgb8,
                                         PixelFormat::kRgba8, PixelFormat::kBayerRggb8,
                                         PixelFormat::kBayerGrbg8, PixelFormat::kBayerGbrg8,
                                         PixelFormat::kBayerBggr8),
                         formatName);

TEST_F(FrameUploaderTest, MakesEveryPictureOpaque) {
  FrameUploader uploader{ShaderLibrary{}};
  const hal::Image image = randomImage({.pixelFormat = PixelFormat::kRgba8, .size = {5, 3}});
  hal::Image back = readRgba8(uploader.upload(image.view(), {5, 3}));
  for (std::size_t i = 3; i < back.plane(0).size(); i += 4) EXPECT_EQ(back.plane(0)[i], 255);
}

TEST_F(FrameUploaderTest, ReadsPaddedRows) {
  FrameUploader uploader{ShaderLibrary{}};
  for (const PixelFormat format :
       {PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kRgba8, PixelFormat::kYuyv,
        PixelFormat::kNv12, PixelFormat::kI420, PixelFormat::kBayerRggb8}) {
    const hal::Image image = randomImage({.pixelFormat = format, .size = {7, 5}});
    for (const std::size_t extra : {1U, 2U, 3U, 4U, 12U, 25U}) {  // whole texels and not
      const PaddedImage padded(image.view(), extra);
      ASSERT_TRUE(padded.view().isComplete());
      EXPECT_LE(errorOf(uploader, padded.view()), kYcbcrTolerance)
          << toString(format) << " padded by " << extra;
    }
  }
}

TEST_F(FrameUploaderTest, FollowsChangesOfSizeFormatAndEncoding) {
  FrameUploader uploader{ShaderLibrary{}};
  const hal::ColorEncoding full709{.matrix = ColorMatrix::kBt709, .range = ColorRange::kFull};
  for (const hal::FrameFormat& format :
       {hal::FrameFormat{.pixelFormat = PixelFormat::kNv12, .size = {8, 6}},
        hal::FrameFormat{.pixelFormat = PixelFormat::kNv12, .size = {8, 6}, .encoding = full709},
        hal::FrameFormat{.pixelFormat = PixelFormat::kI420, .size = {8, 6}, .encoding = full709},
        hal::FrameFormat{.pixelFormat = PixelFormat::kRgb8, .size = {8, 6}},
        hal::FrameFormat{.pixelFormat = PixelFormat::kYuyv, .size = {9, 4}},
        hal::FrameFormat{.pixelFormat = PixelFormat::kNv12, .size = {8, 6}}}) {
    const hal::Image image = randomImage(format, 7);
    EXPECT_LE(errorOf(uploader, image.view()), kYcbcrTolerance) << toString(format.pixelFormat);
  }
}

struct Bar {
  std::array<std::uint8_t, 3> ycbcr;
  std::array<int, 3> rgb;
};

// 75 % colour bars, limited range, as SMPTE RP 219 and ITU-R BT.801-1 tabulate their codes.
constexpr std::array<Bar, 8> kBars601{{{{180, 128, 128}, {191, 191, 191}},
                                       {{162, 44, 142}, {191, 191, 0}},
                                       {{131, 156, 44}, {0, 191, 191}},
                                       {{112, 72, 58}, {0, 191, 0}},
                                       {{84, 184, 198}, {191, 0, 191}},
                                       {{65, 100, 212}, {191, 0, 0}},
                                       {{35, 212, 114}, {0, 0, 191}},
                                       {{16, 128, 128}, {0, 0, 0}}}};
constexpr std::array<Bar, 8> kBars709{{{{180, 128, 128}, {191, 191, 191}},
                                       {{168, 44, 136}, {191, 191, 0}},
                                       {{145, 147, 44}, {0, 191, 191}},
                                       {{133, 63, 52}, {0, 191, 0}},
                                       {{63, 193, 204}, {191, 0, 191}},
                                       {{51, 109, 212}, {191, 0, 0}},
                                       {{28, 212, 120}, {0, 0, 191}},
                                       {{16, 128, 128}, {0, 0, 0}}}};

void expectBar(FrameUploader& uploader, const Bar& bar, ColorMatrix matrix) {
  hal::Image image({.pixelFormat = PixelFormat::kI420,
                    .size = {6, 4},
                    .encoding = {.matrix = matrix, .range = ColorRange::kLimited}});
  for (int plane = 0; plane < 3; ++plane) {
    std::ranges::fill(image.plane(plane), bar.ycbcr[static_cast<std::size_t>(plane)]);
  }
  hal::Image back = readRgba8(uploader.upload(image.view(), {6, 4}));
  EXPECT_LE(largestError(back, oracles::rgbOf(image.view())), 1.0);
  for (std::size_t i = 0; i < back.plane(0).size(); ++i) {
    if (i % 4 < 3) {
      // The codes themselves are rounded, which is worth up to 1.3 of blue.
      EXPECT_NEAR(back.plane(0)[i], bar.rgb[i % 4], 2) << int{bar.ycbcr[0]} << " channel " << i % 4;
    }
  }
}

TEST_F(FrameUploaderTest, ShowsColourBarsInTheirColours) {
  FrameUploader uploader{ShaderLibrary{}};
  for (const Bar& bar : kBars601) expectBar(uploader, bar, ColorMatrix::kBt601);
  for (const Bar& bar : kBars709) expectBar(uploader, bar, ColorMatrix::kBt709);
}

// Malvar's corrections vanish on a ramp, so that a mosaic of one gives the ramp back.
TEST_F(FrameUploaderTest, DemosaicsASmoothRampWithoutLoss) {
  FrameUploader uploader{ShaderLibrary{}};
  constexpr FrameSize kSize{32, 24};
  const auto ramp = [](int x, int y) {
    return std::array{20 + 4 * x, 30 + 2 * x + 4 * y, 220 - 6 * y};
  };
  const std::array<std::pair<PixelFormat, std::array<std::size_t, 4>>, 4> patterns{
      {{PixelFormat::kBayerRggb8, {0, 1, 1, 2}},
       {PixelFormat::kBayerGrbg8, {1, 0, 2, 1}},
       {PixelFormat::kBayerGbrg8, {1, 2, 0, 1}},
       {PixelFormat::kBayerBggr8, {2, 1, 1, 0}}}};
  for (const auto& [format, channels] : patterns) {
    hal::Image mosaic({.pixelFormat = format, .size = kSize});
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const std::size_t channel = channels[static_cast<std::size_t>(2 * (y & 1) + (x & 1))];
        mosaic.row(0, y)[static_cast<std::size_t>(x)] =
            static_cast<std::uint8_t>(ramp(x, y)[channel]);
      }
    }
    hal::Image back = readRgba8(uploader.upload(mosaic.view(), kSize));
    for (int y = 2; y < kSize.height - 2; ++y) {
      for (int x = 2; x < kSize.width - 2; ++x) {
        for (std::size_t c = 0; c < 3; ++c) {
          ASSERT_EQ(back.row(0, y)[static_cast<std::size_t>(x) * 4 + c], ramp(x, y)[c])
              << toString(format) << " at " << x << "," << y << " channel " << c;
        }
      }
    }
  }
}

TEST_F(FrameUploaderTest, ScalesToTheSizeThatIsAsked) {
  FrameUploader uploader{ShaderLibrary{}};
  const hal::Image image = randomImage({.pixelFormat = PixelFormat::kRgb8, .size = {32, 24}});
  hal::Image back = readRgba8(uploader.upload(image.view(), {16, 12}));
  EXPECT_LE(largestError(back, resampledByArea(oracles::rgbOf(image.view()), {16, 12})), 1.25);
}

}  // namespace
}  // namespace pleinair::gpu
