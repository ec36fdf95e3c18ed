#include "hal/outputs/v4l2_loopback/negotiation.h"

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/fake_loopback.h"

namespace pleinair::hal::loopback {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using testing::ElementsAre;
using testing::HasSubstr;

FrameFormat format(PixelFormat pixelFormat, FrameSize size) {
  return {.pixelFormat = pixelFormat, .size = size, .encoding = {}};
}

TEST(FrameLayout, IsPackedWithoutAStride) {
  const auto yuyv = FrameLayout::of(format(PixelFormat::kYuyv, {6, 4}), 0);
  ASSERT_TRUE(yuyv);
  EXPECT_EQ(yuyv->bytes, 6u * 2 * 4);
  const auto nv12 = FrameLayout::of(format(PixelFormat::kNv12, {6, 4}), 0);
  ASSERT_TRUE(nv12);
  EXPECT_THAT(nv12->offsetBytes, ElementsAre(0, 24, 0));
  EXPECT_EQ(nv12->bytes, 36u);
  const auto i420 = FrameLayout::of(format(PixelFormat::kI420, {6, 4}), 0);
  ASSERT_TRUE(i420);
  EXPECT_THAT(i420->offsetBytes, ElementsAre(0, 24, 30));
  EXPECT_EQ(i420->bytes, 36u);
}

TEST(FrameLayout, GivesChromaItsShareOfAStride) {
  const auto nv12 = FrameLayout::of(format(PixelFormat::kNv12, {6, 4}), 8);
  ASSERT_TRUE(nv12);
  EXPECT_THAT(nv12->strideBytes, ElementsAre(8, 8, 0));
  EXPECT_EQ(nv12->bytes, 48u);
  const auto i420 = FrameLayout::of(format(PixelFormat::kI420, {6, 4}), 8);
  ASSERT_TRUE(i420);
  EXPECT_THAT(i420->strideBytes, ElementsAre(8, 4, 4));
  EXPECT_THAT(i420->offsetBytes, ElementsAre(0, 32, 40));
  EXPECT_EQ(i420->bytes, 48u);
}

TEST(FrameLayout, RefusesAStrideThatIsTooShort) {
  EXPECT_FALSE(FrameLayout::of(format(PixelFormat::kYuyv, {6, 4}), 11));
  EXPECT_FALSE(FrameLayout::of(format(PixelFormat::kNv12, {6, 4}), 5));
  EXPECT_FALSE(FrameLayout::of(format(PixelFormat::kI420, {7, 4}), 7)) << "chroma needs 4 of 3.5";
}

TEST(FrameLayout, PacksPlaneAfterPlaneAndLeavesThePadding) {
  const FrameFormat i420 = format(PixelFormat::kI420, {4, 2});
  Image picture(i420);
  const std::vector<std::uint8_t> luma{1, 2, 3, 4, 5, 6, 7, 8};
  std::ranges::copy(luma, picture.plane(0).begin());
  picture.plane(1)[0] = 11;
  picture.plane(1)[1] = 12;
  picture.plane(2)[0] = 21;
  picture.plane(2)[1] = 22;
  const auto layout = FrameLayout::of(i420, 6);
  ASSERT_TRUE(layout);
  std::vector<std::uint8_t> frame(layout->bytes, 99);
  layout->pack(picture.view(), frame);
  EXPECT_THAT(frame, ElementsAre(1, 2, 3, 4, 99, 99, 5, 6, 7, 8, 99, 99,  //
                                 11, 12, 99, 21, 22, 99));
}

class Negotiation : public testing::Test {
 protected:
  Negotiation() { fd_ = fake_.open("/dev/video9", O_RDWR | O_NONBLOCK); }

  Result<Agreement> negotiate(FrameSize size, std::optional<PixelFormat> layout = {}) {
    return loopback::negotiate(fake_, fd_, "/dev/video9", {.size = size, .framePeriod = {}},
                               layout);
  }

  support::FakeLoopback fake_;
  support::FakeOutputNode& node_ = fake_.node("/dev/video9");
  int fd_ = -1;
};

TEST_F(Negotiation, AsksForEverythingExplicitly) {
  const Result<Agreement> agreement = negotiate({640, 480});
  ASSERT_TRUE(agreement) << agreement.error().message();
  ASSERT_EQ(node_.asked.size(), 1u);
  const v4l2_pix_format& asked = node_.asked.front();
  EXPECT_EQ(asked.pixelformat, V4L2_PIX_FMT_YUYV);
  EXPECT_EQ(asked.width, 640u);
  EXPECT_EQ(asked.height, 480u);
  EXPECT_EQ(asked.field, V4L2_FIELD_NONE);
  EXPECT_EQ(asked.bytesperline, 1280u);
  EXPECT_EQ(asked.sizeimage, 614400u);
  EXPECT_EQ(asked.colorspace, V4L2_COLORSPACE_SRGB);
  EXPECT_EQ(asked.ycbcr_enc, V4L2_YCBCR_ENC_601);
  EXPECT_EQ(asked.quantization, V4L2_QUANTIZATION_LIM_RANGE);
  EXPECT_EQ(asked.priv, V4L2_PIX_FMT_PRIV_MAGIC);
}

TEST_F(Negotiation, WritesAFramesBytesAndNotItsPages) {
  const Result<Agreement> agreement = negotiate({100, 50});
  ASSERT_TRUE(agreement) << agreement.error().message();
  EXPECT_EQ(agreement->frameBytes, 10000u) << "VIDIOC_S_FMT answered 12288";
}

TEST_F(Negotiation, RoundsOddSidesUp) {
  const Result<Agreement> agreement = negotiate({33, 17}, PixelFormat::kI420);
  ASSERT_TRUE(agreement) << agreement.error().message();
  EXPECT_EQ(agreement->layout.format.size, (FrameSize{34, 18}));
}

TEST_F(Negotiation, TakesTheLayoutThatTheDeviceHas) {
  node_.layouts = {V4L2_PIX_FMT_YUV420};
  const Result<Agreement> agreement = negotiate({64, 48});
  ASSERT_TRUE(agreement) << agreement.error().message();
  EXPECT_EQ(agreement->layout.format.pixelFormat, PixelFormat::kI420);
  EXPECT_EQ(node_.asked.size(), 1u) << "it was listed";
}

TEST_F(Negotiation, TriesOneAfterTheOtherWhereNothingIsListed) {
  for (const bool refuses : {false, true}) {
    node_.listsLayouts = false;
    node_.layouts = {V4L2_PIX_FMT_NV12};
    node_.refusesOthers = refuses;
    const Result<Agreement> agreement = negotiate({64, 48});
    ASSERT_TRUE(agreement) << agreement.error().message();
    EXPECT_EQ(agreement->layout.format.pixelFormat, PixelFormat::kNv12);
  }
}

TEST_F(Negotiation, RefusesADeviceWithoutALayoutOfOurs) {
  node_.layouts = {V4L2_PIX_FMT_BGR32};
  const Result<Agreement> agreement = negotiate({64, 48});
  ASSERT_FALSE(agreement);
  EXPECT_EQ(agreement.error().kind, ErrorKind::kUnsupported);
  EXPECT_THAT(agreement.error().message(), HasSubstr("BGR4"));
  EXPECT_THAT(agreement.error().message(), HasSubstr("--list-formats-out"));
}

TEST_F(Negotiation, TakesAWantedLayoutOnly) {
  node_.layouts = {V4L2_PIX_FMT_YUYV};
  const Result<Agreement> agreement = negotiate({64, 48}, PixelFormat::kNv12);
  ASSERT_FALSE(agreement);
  EXPECT_EQ(agreement.error().kind, ErrorKind::kUnsupported);
}

TEST_F(Negotiation, FollowsAFormatThatIsHeld) {
  node_.isHeld = true;
  node_.format.width = 320;
  node_.format.height = 240;
  node_.format.pixelformat = V4L2_PIX_FMT_NV12;
  node_.format.bytesperline = 320;
  node_.format.sizeimage = 115200;
  const Result<Agreement> agreement = negotiate({640, 480});
  ASSERT_TRUE(agreement) << agreement.error().message();
  EXPECT_EQ(agreement->layout.format.pixelFormat, PixelFormat::kNv12);
  EXPECT_EQ(agreement->layout.format.size, (FrameSize{320, 240}));

  const Result<Agreement> other = negotiate({640, 480}, PixelFormat::kI420);
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().kind, ErrorKind::kBusy);
  EXPECT_THAT(other.error().message(), HasSubstr("keeps its format NV12"));
  EXPECT_THAT(other.error().message(), HasSubstr("fuser -v /dev/video9"));
}

TEST_F(Negotiation, SaysWhatHoldsABusyDevice) {
  node_.setFormatAnswer = -EBUSY;
  const Result<Agreement> agreement = negotiate({64, 48});
  ASSERT_FALSE(agreement);
  EXPECT_EQ(agreement.error().kind, ErrorKind::kBusy);
  EXPECT_EQ(node_.asked.size(), 1u) << "another layout would not help";
}

TEST_F(Negotiation, TellsALostDevice) {
  node_.setFormatAnswer = -ENODEV;
  const Result<Agreement> agreement = negotiate({64, 48});
  ASSERT_FALSE(agreement);
  EXPECT_EQ(agreement.error().kind, ErrorKind::kDeviceLost);
}

TEST_F(Negotiation, KeepsToTheStrideThatIsAnswered) {
  node_.alignment = 64;
  const Result<Agreement> agreement = negotiate({50, 30}, PixelFormat::kI420);
  ASSERT_TRUE(agreement) << agreement.error().message();
  EXPECT_EQ(agreement->layout.strideBytes[0], 64u);
  EXPECT_EQ(agreement->layout.strideBytes[1], 32u);
  EXPECT_EQ(agreement->frameBytes, 64u * 30 * 3 / 2);
}

TEST_F(Negotiation, RefusesAnswersThatCannotBe) {
  node_.isHeld = true;
  node_.format.pixelformat = V4L2_PIX_FMT_YUYV;
  node_.format.width = 64;
  node_.format.height = 48;
  node_.format.bytesperline = 100;  // too short
  node_.format.sizeimage = 64 * 48 * 2;
  Result<Agreement> agreement = negotiate({64, 48});
  ASSERT_FALSE(agreement);
  EXPECT_EQ(agreement.error().kind, ErrorKind::kUnsupported);
  node_.format.bytesperline = 128;
  node_.format.sizeimage = 100;  // fewer than the rows
  EXPECT_FALSE(negotiate({64, 48}));
  node_.format.sizeimage = 0xFFFFFFFF;
  node_.format.width = 40000;
  agreement = negotiate({64, 48});
  ASSERT_FALSE(agreement);
  EXPECT_THAT(agreement.error().message(), HasSubstr("40000x48"));
  node_.format.width = 33;
  EXPECT_FALSE(negotiate({64, 48})) << "odd";
}

TEST_F(Negotiation, PaintsInTheColoursThatAreAnswered) {
  node_.isHeld = true;
  node_.format.pixelformat = V4L2_PIX_FMT_YUYV;
  node_.format.width = 64;
  node_.format.height = 48;
  node_.format.sizeimage = 64 * 48 * 2;
  struct Case {
    std::uint32_t colorspace, encoding, quantization;
    ColorEncoding expected;
  };
  for (const Case& each : {Case{V4L2_COLORSPACE_SRGB,
                                V4L2_YCBCR_ENC_DEFAULT,
                                V4L2_QUANTIZATION_DEFAULT,
                                {ColorMatrix::kBt601, ColorRange::kLimited}},
                           Case{V4L2_COLORSPACE_REC709,
                                V4L2_YCBCR_ENC_DEFAULT,
                                V4L2_QUANTIZATION_DEFAULT,
                                {ColorMatrix::kBt709, ColorRange::kLimited}},
                           Case{V4L2_COLORSPACE_SRGB,
                                V4L2_YCBCR_ENC_709,
                                V4L2_QUANTIZATION_FULL_RANGE,
                                {ColorMatrix::kBt709, ColorRange::kFull}},
                           Case{V4L2_COLORSPACE_JPEG,
                                V4L2_YCBCR_ENC_DEFAULT,
                                V4L2_QUANTIZATION_DEFAULT,
                                {ColorMatrix::kBt601, ColorRange::kFull}}}) {
    node_.format.colorspace = each.colorspace;
    node_.format.ycbcr_enc = each.encoding;
    node_.format.quantization = each.quantization;
    const Result<Agreement> agreement = negotiate({64, 48});
    ASSERT_TRUE(agreement) << agreement.error().message();
    EXPECT_EQ(agreement->layout.format.encoding, each.expected);
  }
}

TEST(FractionOf, FindsTheUsualRates) {
  struct Case {
    Duration period;
    std::uint32_t numerator, denominator;
  };
  for (const Case& each :
       {Case{milliseconds(40), 1, 25}, Case{nanoseconds(33333333), 1, 30},
        Case{nanoseconds(33366667), 1001, 30000}, Case{nanoseconds(16666667), 1, 60},
        Case{nanoseconds(41708333), 1001, 24000}, Case{milliseconds(400), 2, 5},
        Case{std::chrono::seconds(1), 1, 1}}) {
    const v4l2_fract fraction = fractionOf(each.period);
    EXPECT_EQ(fraction.numerator, each.numerator) << each.period.count();
    EXPECT_EQ(fraction.denominator, each.denominator) << each.period.count();
  }
}

TEST(FractionOf, IsNeverZero) {
  for (const Duration period : {Duration(-1), Duration(0), Duration(1), Duration::max()}) {
    const v4l2_fract fraction = fractionOf(period);
    EXPECT_GT(fraction.numerator, 0u);
    EXPECT_GT(fraction.denominator, 0u);
  }
}

}  // namespace
}  // namespace pleinair::hal::loopback
