#include "pipeline/tracking/image/luma.h"

#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/pose/tag_detector.h"
#include "tests/support/tag_scene.h"
#include "tests/support/textured_plane.h"

namespace pleinair::tracking {
namespace {

using hal::PixelFormat;

constexpr std::array<PixelFormat, 10> kAllFormats{
    PixelFormat::kGrey8,      PixelFormat::kRgb8,       PixelFormat::kRgba8,
    PixelFormat::kYuyv,       PixelFormat::kNv12,       PixelFormat::kI420,
    PixelFormat::kBayerRggb8, PixelFormat::kBayerGrbg8, PixelFormat::kBayerGbrg8,
    PixelFormat::kBayerBggr8};

/// The channel (0 red, 1 green, 2 blue) of each pixel in a mosaic's first two rows, by the mosaic's
/// name.
int mosaicChannel(PixelFormat format, int x, int y) {
  const std::string_view names = format == PixelFormat::kBayerRggb8   ? "RGGB"
                                 : format == PixelFormat::kBayerGrbg8 ? "GRBG"
                                 : format == PixelFormat::kBayerGbrg8 ? "GBRG"
                                                                      : "BGGR";
  const char name = names[static_cast<std::size_t>(2 * (y % 2) + x % 2)];
  return name == 'R' ? 0 : name == 'G' ? 1 : 2;
}

TEST(LumaConverter, WeighsColoursByBt601) {
  constexpr std::array<std::uint8_t, 4> kColour{200, 100, 20, 77};
  const double expected = 0.299 * 200 + 0.587 * 100 + 0.114 * 20;
  for (const PixelFormat format : kAllFormats) {
    if (hal::isYCbCr(format) || format == PixelFormat::kGrey8) continue;
    hal::Image image({.pixelFormat = format, .size = {9, 7}});
    const std::size_t channels = hal::rowBytes(format, 0, 1);
    for (int y = 0; y < 7; ++y) {
      const auto row = image.row(0, y);
      for (std::size_t i = 0; i < row.size(); ++i) {
        row[i] =
            hal::isBayer(format)
                ? kColour[static_cast<std::size_t>(mosaicChannel(format, static_cast<int>(i), y))]
                : kColour[i % channels];
      }
    }
    LumaConverter converter;
    const hal::PlaneView luma = converter.convert(image.view());
    for (const std::size_t y : {0U, 3U, 6U}) {
      for (const std::size_t x : {0U, 4U, 8U}) {
        EXPECT_NEAR(luma.bytes[y * luma.strideBytes + x], expected, 1.01)
            << hal::toString(format) << " at " << x << ", " << y;
      }
    }
  }
}

TEST(LumaConverter, LendsThePlaneOfFormatsThatHaveOne) {
  for (const PixelFormat format : {PixelFormat::kGrey8, PixelFormat::kNv12, PixelFormat::kI420}) {
    hal::Image image({.pixelFormat = format, .size = {5, 3}});
    LumaConverter converter;
    EXPECT_EQ(converter.convert(image.view()).bytes.data(), image.plane(0).data());
  }
}

TEST(LumaConverter, TakesPicturesOfAnySize) {
  LumaConverter converter;
  for (const PixelFormat format : kAllFormats) {
    for (int height = 1; height <= 4; ++height) {
      for (int width = 1; width <= 4; ++width) {
        const hal::Image image({.pixelFormat = format, .size = {width, height}});
        const hal::PlaneView luma = converter.convert(image.view());
        ASSERT_GE(luma.strideBytes, static_cast<std::size_t>(width));
        EXPECT_GE(luma.bytes.size(), luma.strideBytes * static_cast<std::size_t>(height));
      }
    }
  }
}

/// Tags are found at the same position in every format: no mosaic shifts the image.
TEST(LumaConverter, ShiftsNoTag) {
  const CameraModel camera({.fx = 500.0, .fy = 500.0, .cx = 160.0, .cy = 120.0}, {}, {320, 240});
  const support::SceneTag tag{
      .id = 11, .edgeMetres = 0.1, .worldFromTag = support::poseOf({0.3, 0.2, 0.4}, {0, 0, 0.4})};
  const hal::Image grey = support::renderTags(camera, glm::dmat4(1.0), {&tag, 1});
  const TagCornersPx truth = support::trueCorners(camera, tag.worldFromTag, tag.edgeMetres);
  TagDetector detector;
  LumaConverter converter;
  for (const PixelFormat format : kAllFormats) {
    const hal::Image picture = support::neutralPicture(grey, format);
    DetectionCounters counters;
    const auto found = detector.detect(converter.convert(picture.view()), picture.size(), counters);
    ASSERT_EQ(found.size(), 1U) << hal::toString(format);
    glm::dvec2 shift(0.0);
    for (std::size_t i = 0; i < 4; ++i) shift += (found[0].corners[i] - truth[i]) / 4.0;
    EXPECT_LT(glm::length(shift), 0.1) << hal::toString(format);
  }
}

/// What a camera has reduced in the way of the pyramid is followed as the whole frame is.
TEST(LumaFrame, OfASecondImageMeasuresInPxOfTheFrame) {
  constexpr hal::FrameSize kWhole{1280, 960};
  constexpr hal::FrameSize kSmall{640, 480};
  const hal::Image whole = support::renderWall({.size = kWhole, .noiseSigma = 2.0});
  hal::Image small({.pixelFormat = PixelFormat::kGrey8, .size = kSmall});
  const hal::PlaneView plane = whole.view().planes[0];
  auto* const bytes = const_cast<std::uint8_t*>(plane.bytes.data());
  const cv::Mat from(kWhole.height, kWhole.width, CV_8UC1, bytes, plane.strideBytes);
  cv::Mat to(kSmall.height, kSmall.width, CV_8UC1, small.plane(0).data());
  cv::resize(from, to, to.size(), 0.0, 0.0, cv::INTER_AREA);
  LumaFrame ofWhole, ofSmall;
  ofWhole.take(whole.view());
  ofSmall.takeReduced(small.view().planes[0], kSmall, kWhole);
  EXPECT_EQ(ofSmall.size(), kWhole);
  const auto a = ofWhole.pyramid();
  const auto b = ofSmall.pyramid();
  EXPECT_EQ(b->frameSize(), kWhole);
  EXPECT_EQ(b->reduction(), a->reduction());
  EXPECT_EQ(b->reduction(), glm::dvec2(2.0));
  ASSERT_EQ(b->picture().size(), a->picture().size());
  EXPECT_EQ(cv::norm(a->picture(), b->picture(), cv::NORM_INF), 0.0);
}

TEST(LumaFrame, OfASecondImageThatIsLargerThanThePyramidIsReduced) {
  constexpr hal::FrameSize kWhole{1920, 1080};
  constexpr hal::FrameSize kSmall{960, 540};
  const hal::Image small = support::renderWall({.size = kSmall});
  LumaFrame frame;
  frame.takeReduced(small.view().planes[0], kSmall, kWhole);
  const auto pyramid = frame.pyramid();
  EXPECT_EQ(pyramid->picture().cols, LumaFrame::kLongSidePx);
  EXPECT_EQ(pyramid->reduction(), glm::dvec2(3.0));
}

}  // namespace
}  // namespace pleinair::tracking
