// The format that S_FMT answers is the one that counts.
#include "hal/cameras/v4l2/format.h"

#include "hal/cameras/v4l2/layout.h"
#include "hal/v4l2/formats.h"
#include "tests/unit/hal/v4l2/fake_camera.h"

namespace pleinair::hal::v4l2 {
namespace {

using testing::HasSubstr;

struct LayoutCase {
  std::string name;
  std::uint32_t fourcc;
  std::uint32_t caps;
  PixelFormat pixelFormat;
};

class V4l2Layouts : public FakeCamera, public testing::WithParamInterface<LayoutCase> {
 protected:
  support::FakeVideo video(FrameSize size, std::size_t padding) const {
    return {.caps = GetParam().caps | V4L2_CAP_STREAMING,
            .formats = {{.fourcc = GetParam().fourcc, .sizes = {size}}},
            .rowPadding = padding};
  }
};

TEST_P(V4l2Layouts, AreReadWithTheDriversStride) {
  for (const std::size_t padding : {0u, 2u, 48u}) {
    plug(video({64, 48}, padding));
    const StreamFormat format = startOrFail();
    EXPECT_EQ(format.frame.pixelFormat, GetParam().pixelFormat);
    EXPECT_EQ(format.frame.size, (FrameSize{64, 48}));
    for (int i = 0; i < 2; ++i) {
      const CapturedFrame frame = frameOrFail();
      EXPECT_EQ(frame.health, FrameHealth::kValid);
      EXPECT_EQ(frame.image.map().view().planes[0].strideBytes,
                rowBytes(GetParam().pixelFormat, 0, 64) + padding);
      expectPicture(frame, i);
    }
    camera().stop();
  }
}

TEST_P(V4l2Layouts, ArePackedWhereTheDriverSaysNoStride) {
  support::FakeVideo packed = video({64, 48}, 0);
  packed.reportsNoStride = true;
  plug(packed);
  startOrFail();
  expectPicture(frameOrFail(), 0);
}

TEST_P(V4l2Layouts, MayHaveOddHeights) {
  plug(video({34, 23}, 4));
  EXPECT_EQ(startOrFail().frame.size, (FrameSize{34, 23}));
  expectPicture(frameOrFail(), 0);
}

constexpr std::uint32_t kSingle = V4L2_CAP_VIDEO_CAPTURE;
constexpr std::uint32_t kMulti = V4L2_CAP_VIDEO_CAPTURE_MPLANE;

INSTANTIATE_TEST_SUITE_P(
    All, V4l2Layouts,
    testing::Values(LayoutCase{"Yuyv", V4L2_PIX_FMT_YUYV, kSingle, PixelFormat::kYuyv},
                    LayoutCase{"YuyvMulti", V4L2_PIX_FMT_YUYV, kMulti, PixelFormat::kYuyv},
                    LayoutCase{"Nv12", V4L2_PIX_FMT_NV12, kSingle, PixelFormat::kNv12},
                    LayoutCase{"Nv12Multi", V4L2_PIX_FMT_NV12, kMulti, PixelFormat::kNv12},
                    LayoutCase{"Nv12m", V4L2_PIX_FMT_NV12M, kMulti, PixelFormat::kNv12},
                    LayoutCase{"I420", V4L2_PIX_FMT_YUV420, kSingle, PixelFormat::kI420},
                    LayoutCase{"I420m", V4L2_PIX_FMT_YUV420M, kMulti, PixelFormat::kI420},
                    LayoutCase{"Rgb", V4L2_PIX_FMT_RGB24, kSingle, PixelFormat::kRgb8},
                    LayoutCase{"Grey", V4L2_PIX_FMT_GREY, kSingle, PixelFormat::kGrey8},
                    LayoutCase{"Rggb", V4L2_PIX_FMT_SRGGB8, kSingle, PixelFormat::kBayerRggb8},
                    LayoutCase{"Grbg", V4L2_PIX_FMT_SGRBG8, kSingle, PixelFormat::kBayerGrbg8},
                    LayoutCase{"Gbrg", V4L2_PIX_FMT_SGBRG8, kSingle, PixelFormat::kBayerGbrg8},
                    LayoutCase{"Bggr", V4L2_PIX_FMT_SBGGR8, kSingle, PixelFormat::kBayerBggr8}),
    [](const auto& each) { return each.param.name; });

class V4l2Format : public FakeCamera {};

TEST_F(V4l2Format, OfAnOddWidthHasRoomForItsLastColour) {
  // The stride of brightness is an odd number, and colours come in pairs.
  plug({.formats = {{.fourcc = V4L2_PIX_FMT_NV12, .sizes = {{35, 24}}}},
        .rowPadding = 1,
        .amendFormat = [](v4l2_format& format) { format.fmt.pix.bytesperline = 35; }});
  startOrFail();
  const CapturedFrame frame = frameOrFail();
  EXPECT_TRUE(frame.image.isComplete());
  EXPECT_EQ(frame.image.map().view().planes[1].strideBytes, 36u);
}

TEST_F(V4l2Format, IsWhatTheDeviceMadeOfTheRequest) {
  plug({.formats = {{.sizes = {{64, 48}}, .periods = {{1, 30}, {1, 15}}}}});
  const StreamFormat format = startOrFail({.size = FrameSize{100, 80}, .framePeriod = 66ms});
  EXPECT_EQ(format.frame.size, (FrameSize{64, 48}));
  EXPECT_EQ(format.framePeriod, Duration(66'666'666));
}

TEST_F(V4l2Format, MayBeAnotherThanWasAskedFor) {
  support::FakeVideo video{.formats = {{.fourcc = V4L2_PIX_FMT_YUYV}}};
  video.amendFormat = [](v4l2_format& format) { format.fmt.pix.width = 60; };
  plug(video);
  EXPECT_EQ(startOrFail().frame.size, (FrameSize{60, 48}));
}

TEST_F(V4l2Format, ThatIsNotReadIsRefused) {
  support::FakeVideo video;
  video.amendFormat = [](v4l2_format& format) { format.fmt.pix.pixelformat = V4L2_PIX_FMT_H264; };
  plug(video);
  EXPECT_THAT(startError().message(), HasSubstr("answers with the pixel format H264"));
}

TEST_F(V4l2Format, BeyondTheLimitsIsRefused) {
  support::FakeVideo video;
  video.amendFormat = [](v4l2_format& format) { format.fmt.pix.width = 0xFFFFFFFF; };
  plug(video);
  EXPECT_THAT(startError().message(), HasSubstr("frames of 4294967295x48 px"));
}

TEST_F(V4l2Format, WithFieldsApartIsRefused) {
  support::FakeVideo video;
  video.amendFormat = [](v4l2_format& format) { format.fmt.pix.field = V4L2_FIELD_ALTERNATE; };
  plug(video);
  EXPECT_THAT(startError().message(), HasSubstr("fields of a frame separately"));
}

TEST_F(V4l2Format, WithTheWrongNumberOfPlanesIsRefused) {
  support::FakeVideo video{.caps = V4L2_CAP_VIDEO_CAPTURE_MPLANE | V4L2_CAP_STREAMING,
                           .formats = {{.fourcc = V4L2_PIX_FMT_NV12M}}};
  video.amendFormat = [](v4l2_format& format) { format.fmt.pix_mp.num_planes = 1; };
  plug(video);
  EXPECT_THAT(startError().message(), HasSubstr("answers with 1 planes of NM12"));
}

TEST_F(V4l2Format, WithoutARateHasNoPeriod) {
  plug({.failures = {{VIDIOC_G_PARM, ENOTTY}}});
  EXPECT_EQ(startOrFail().framePeriod, std::nullopt);
  frameOrFail();
}

TEST_F(V4l2Format, SaysItsColorEncoding) {
  plug({.colorspace = V4L2_COLORSPACE_REC709, .quantization = V4L2_QUANTIZATION_FULL_RANGE});
  EXPECT_EQ(startOrFail().frame.encoding, (ColorEncoding{.matrix = ColorMatrix::kBt709,
                                                         .range = ColorRange::kFull,
                                                         .primaries = ColorPrimaries::kBt709,
                                                         .transfer = ColorTransfer::kBt709}));
}

TEST(V4l2ColorEncoding, FollowsTheKernelsDefaults) {
  using E = ColorEncoding;
  const E bt601{.matrix = ColorMatrix::kBt601, .range = ColorRange::kLimited};
  const E bt709{.matrix = ColorMatrix::kBt709, .range = ColorRange::kLimited};
  const E jfif{.matrix = ColorMatrix::kBt601, .range = ColorRange::kFull};
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_DEFAULT, 0, 0), bt601);
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_SRGB, 0, 0), bt601);
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_SMPTE170M, 0, 0), bt601);
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_REC709, 0, 0), bt709);
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_JPEG, 0, 0), jfif);
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_SRGB, V4L2_YCBCR_ENC_709, 0), bt709);
  EXPECT_EQ(
      colorEncodingOf(V4L2_COLORSPACE_REC709, V4L2_YCBCR_ENC_601, V4L2_QUANTIZATION_FULL_RANGE),
      jfif);
  EXPECT_EQ(colorEncodingOf(V4L2_COLORSPACE_BT2020, 0, 0).matrix, ColorMatrix::kBt709);
}

TEST(V4l2Fractions, AreThoseOfDriversLists) {
  const auto expectFraction = [](Duration period, std::uint32_t numerator,
                                 std::uint32_t denominator) {
    const v4l2_fract fraction = fractionOf(period);
    EXPECT_EQ(fraction.numerator, numerator) << period.count();
    EXPECT_EQ(fraction.denominator, denominator) << period.count();
  };
  expectFraction(Duration(33'333'333), 1, 30);
  expectFraction(Duration(33'366'667), 1001, 30000);
  expectFraction(40ms, 1, 25);
  expectFraction(1s, 1, 1);
  expectFraction(Duration(133'333'333), 1333334, 10'000'000);  // 7.5 per second
  expectFraction(2s, 20'000'000, 10'000'000);
  EXPECT_EQ(durationOf({.numerator = 1, .denominator = 30}), Duration(33'333'333));
  EXPECT_EQ(durationOf({.numerator = 0, .denominator = 30}), std::nullopt);
  EXPECT_EQ(durationOf({.numerator = 1, .denominator = 0}), std::nullopt);
  EXPECT_EQ(durationOf({.numerator = 0xFFFFFFFF, .denominator = 1}), Duration(4'294'967'295s));
}

}  // namespace
}  // namespace pleinair::hal::v4l2
