#include "hal/media/wide_colour.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numeric>

#include <gtest/gtest.h>

#include "hal/media/frame_pixels.h"

extern "C" {
#include <libavutil/mastering_display_metadata.h>
}

namespace pleinair::hal::libav {
namespace {

constexpr FrameSize kSize{32, 16};

struct Coding {
  AVPixelFormat layout = AV_PIX_FMT_YUV420P10LE;
  AVColorPrimaries primaries = AVCOL_PRI_BT2020;
  AVColorTransferCharacteristic transfer = AVCOL_TRC_SMPTE2084;
  AVColorSpace matrix = AVCOL_SPC_BT2020_NCL;
};

/// A frame of one Y'CbCr colour, in 10-bit codes.
Frame frameOf(const Coding& coding, std::array<double, 3> codes, FrameSize size = kSize) {
  Frame frame = makeFrame();
  frame->format = coding.layout;
  frame->width = size.width;
  frame->height = size.height;
  frame->color_primaries = coding.primaries;
  frame->color_trc = coding.transfer;
  frame->colorspace = coding.matrix;
  frame->color_range = AVCOL_RANGE_MPEG;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  for (std::size_t plane = 0; plane < 3; ++plane) {
    const int rows = plane == 0 ? size.height : (size.height + 1) / 2;
    const int columns = plane == 0 ? size.width : (size.width + 1) / 2;
    for (int y = 0; y < rows; ++y) {
      auto* const row = reinterpret_cast<std::uint16_t*>(
          frame->data[plane] + std::ptrdiff_t{y} * frame->linesize[plane]);
      std::fill_n(row, columns, static_cast<std::uint16_t>(std::lround(codes[plane])));
    }
  }
  return frame;
}

/// A neutral frame of this R'G'B' signal, 0 … 1.
Frame greyOf(const Coding& coding, double signal) {
  return frameOf(coding, {64 + 876 * signal, 512, 512});
}

/// The mean colour of what is delivered.
std::array<double, 3> delivered(Frame frame) {
  const Result<LentPicture> picture = lendPicture(std::shared_ptr<const AVFrame>(std::move(frame)));
  if (!picture) {
    ADD_FAILURE() << picture.error().message();
    return {};
  }
  EXPECT_EQ(picture->view.format.pixelFormat, PixelFormat::kRgb8);
  std::array<double, 3> sum{};
  const FrameSize size = picture->view.format.size;
  for (int y = 0; y < size.height; ++y) {
    const auto row = picture->view.row(0, y);
    for (std::size_t i = 0; i < row.size(); ++i) sum.at(i % 3) += row[i];
  }
  for (double& each : sum) each /= static_cast<double>(size.pixels());
  return sum;
}

/// SMPTE ST 2084: the signal of a luminance.
double pqOf(double nits) {
  const double m1 = 0.1593017578125;
  const double m2 = 78.84375;
  const double y = std::pow(nits / 10000, m1);
  return std::pow((0.8359375 + 18.8515625 * y) / (1 + 18.6875 * y), m2);
}
double srgbOf(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

TEST(WideColour, MidTonesOfPqAreTheLightThatTheyStandFor) {
  for (const double nits : {2.0, 10.0, 30.0, 80.0}) {
    const auto colour = delivered(greyOf({}, pqOf(nits)));
    for (const double each : colour) EXPECT_NEAR(each, srgbOf(nits / 203), 1.0) << nits;
  }
}

TEST(WideColour, HighlightsOfPqAreRolledOffBelowWhite) {
  const double white = delivered(greyOf({}, pqOf(203)))[0];
  EXPECT_NEAR(white, srgbOf(160.0 / 203), 2.0);
  const double bright = delivered(greyOf({}, pqOf(600)))[0];
  EXPECT_GT(bright, white + 5);
  EXPECT_LT(bright, 254.9);
  EXPECT_NEAR(delivered(greyOf({}, pqOf(1000)))[0], 255, 1.0);
}

TEST(WideColour, TheFilmsOwnPeakDecides) {
  Frame frame = greyOf({}, pqOf(400));
  AVContentLightMetadata* const light = av_content_light_metadata_create_side_data(frame.get());
  ASSERT_NE(light, nullptr);
  light->MaxCLL = 400;
  EXPECT_NEAR(delivered(std::move(frame))[0], 255, 1.0);
}

TEST(WideColour, HlgReferenceWhiteIsThatOfPq) {
  // ITU-R BT.2408: 75 % of HLG is 203 cd/m² on a display of 1000.
  Coding hlg;
  hlg.transfer = AVCOL_TRC_ARIB_STD_B67;
  const double ofHlg = delivered(greyOf(hlg, 0.75))[0];
  EXPECT_NEAR(ofHlg, delivered(greyOf({}, pqOf(203)))[0], 3.0);
  EXPECT_NEAR(delivered(greyOf(hlg, 1.0))[0], 255, 1.5);
  EXPECT_NEAR(delivered(greyOf(hlg, 0.0))[0], 0, 0.5);
}

TEST(WideColour, RedOfBt709WithinBt2020IsFullRed) {
  // The red of BT.709 in BT.2020's primaries (ITU-R BT.2087 §2: 0.6274, 0.0691, 0.0164 of light),
  // with the gamma of BT.1886.
  const std::array<double, 3> rgb{std::pow(0.6274, 1 / 2.4), std::pow(0.0691, 1 / 2.4),
                                  std::pow(0.0164, 1 / 2.4)};
  const double y = 0.2627 * rgb[0] + 0.6780 * rgb[1] + 0.0593 * rgb[2];
  Coding wide;
  wide.transfer = AVCOL_TRC_BT2020_10;
  const auto colour = delivered(frameOf(
      wide, {64 + 876 * y, 512 + 896 * (rgb[2] - y) / 1.8814, 512 + 896 * (rgb[0] - y) / 1.4746}));
  EXPECT_NEAR(colour[0], 255, 3);
  EXPECT_NEAR(colour[1], 0, 14);
  EXPECT_NEAR(colour[2], 0, 14);
  const auto grey = delivered(greyOf(wide, 0.5));
  for (const double each : grey)
    EXPECT_NEAR(each, 127.5, 1.0) << "neutral colours keep their codes";
}

TEST(WideColour, TenBitsKeepTheirMean) {
  Coding sdr;
  sdr.primaries = AVCOL_PRI_BT709;
  sdr.transfer = AVCOL_TRC_BT709;
  sdr.matrix = AVCOL_SPC_BT709;
  // Between two 8-bit levels: rounding would be off by up to half of one.
  for (int code = 400; code < 404; ++code) {
    const double expected = 255.0 * (code - 64) / 876;
    const auto colour = delivered(frameOf(sdr, {static_cast<double>(code), 512, 512}));
    for (const double each : colour) EXPECT_NEAR(each, expected, 0.12) << code;
  }
}

TEST(WideColour, OddSizesAreTaken) {
  Coding sdr;
  sdr.primaries = AVCOL_PRI_BT709;
  sdr.transfer = AVCOL_TRC_BT709;
  sdr.matrix = AVCOL_SPC_BT709;
  const auto colour = delivered(frameOf(sdr, {502, 512, 512}, {213, 121}));
  for (const double each : colour) EXPECT_NEAR(each, 127.5, 0.25);
}

TEST(WideColour, SemiPlanarFramesAreReadAsPlanarOnes) {
  const Frame planar = greyOf({}, pqOf(80));
  Coding packed;
  packed.layout = AV_PIX_FMT_P010LE;
  Frame frame = makeFrame();
  frame->format = AV_PIX_FMT_P010LE;
  frame->width = kSize.width;
  frame->height = kSize.height;
  ASSERT_GE(av_frame_get_buffer(frame.get(), 0), 0);
  av_frame_copy_props(frame.get(), planar.get());
  frame->color_primaries = AVCOL_PRI_BT2020;
  frame->color_trc = AVCOL_TRC_SMPTE2084;
  frame->colorspace = AVCOL_SPC_BT2020_NCL;
  frame->color_range = AVCOL_RANGE_MPEG;
  for (int plane = 0; plane < 2; ++plane) {
    const int rows = plane == 0 ? kSize.height : kSize.height / 2;
    for (int y = 0; y < rows; ++y) {
      auto* const row = reinterpret_cast<std::uint16_t*>(
          frame->data[plane] + std::ptrdiff_t{y} * frame->linesize[plane]);
      const int code = plane == 0 ? static_cast<int>(std::lround(64 + 876 * pqOf(80))) : 512;
      std::fill_n(row, kSize.width, static_cast<std::uint16_t>(code << 6));
    }
  }
  EXPECT_NEAR(delivered(std::move(frame))[0], srgbOf(80.0 / 203), 1.0);
}

TEST(WideColour, EightBitFilmsAreLentAsTheyAre) {
  Frame frame = makeFrame();
  frame->format = AV_PIX_FMT_YUV420P;
  frame->width = 16;
  frame->height = 16;
  frame->color_primaries = AVCOL_PRI_BT709;
  ASSERT_GE(av_frame_get_buffer(frame.get(), 0), 0);
  EXPECT_FALSE(isWideColour(*frame));
}

TEST(SquarePixels, StretchTheSideThatThePixelsStretch) {
  EXPECT_EQ(squarePixelSize({720, 576}, {16, 15}), (FrameSize{768, 576}));
  EXPECT_EQ(squarePixelSize({1440, 1080}, {4, 3}), (FrameSize{1920, 1080}));
  EXPECT_EQ(squarePixelSize({720, 480}, {8, 9}), (FrameSize{720, 540}));
  EXPECT_EQ(squarePixelSize({8000, 1000}, {2, 1}), (FrameSize{8000, 500})) << "within the limits";
}

TEST(SquarePixels, LeaveWhatIsSquareOrBroken) {
  for (const AVRational aspect : {AVRational{0, 1}, AVRational{1, 1}, AVRational{1000, 1001},
                                  AVRational{-4, 3}, AVRational{4, 0}, AVRational{100, 1}}) {
    EXPECT_EQ(squarePixelSize({720, 576}, aspect), (FrameSize{720, 576})) << aspect.num;
  }
}

}  // namespace
}  // namespace pleinair::hal::libav
