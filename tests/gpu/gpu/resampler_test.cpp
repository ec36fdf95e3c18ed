#include "pipeline/gpu/images/resampler.h"

#include <array>
#include <string>

#include <gtest/gtest.h>

#include "tests/oracles/frame_oracle.h"
#include "tests/support/gl_pictures.h"
#include "tests/support/gl_test.h"

namespace pleinair::gpu {
namespace {

using hal::FrameSize;
using hal::PixelFormat;
using oracles::Picture;
using support::GlTest;
using support::largestError;
using support::randomImage;
using support::readRgba8;
using support::textureOf;
using support::wavyImage;

struct Scaling {
  const char* name;
  FrameSize from;
  FrameSize to;
};

constexpr std::array kScalings{
    Scaling{"half", {64, 48}, {32, 24}},
    Scaling{"threeTimesSmaller", {99, 66}, {30, 20}},  // 3.3
    Scaling{"aThirdSmaller", {64, 48}, {48, 36}},
    Scaling{"tenTimesSmaller", {200, 100}, {20, 10}},
    Scaling{"larger", {40, 30}, {68, 51}},  // 1.7
    Scaling{"wideIntoTall", {64, 36}, {20, 40}},
    Scaling{"tallIntoWide", {30, 60}, {64, 36}},
    Scaling{"toOnePixel", {64, 48}, {1, 1}},
    Scaling{"fromOnePixel", {1, 1}, {7, 5}},
};

class ResamplerTest : public GlTest {};

class ResamplerScalingTest : public GlTest, public testing::WithParamInterface<Scaling> {
 protected:
  hal::Image scaled(const hal::Image& image) {
    Resampler resampler{ShaderLibrary{}};
    return readRgba8(resampler.resample(textureOf(image.view()), GetParam().to));
  }
};

// The rasteriser weighs bilinear taps with 8 bits, and rounds.
constexpr double kTolerance = 2.0;

TEST_P(ResamplerScalingTest, IsTheMeanOfItsTaps) {
  const hal::Image image =
      randomImage({.pixelFormat = PixelFormat::kRgb8, .size = GetParam().from});
  hal::Image result = scaled(image);
  EXPECT_LE(largestError(result, resampledByTaps(oracles::rgbOf(image.view()), GetParam().to)),
            kTolerance);
}

TEST_P(ResamplerScalingTest, KeepsAConstantPictureToTheByte) {
  hal::Image image({.pixelFormat = PixelFormat::kRgb8, .size = GetParam().from});
  std::ranges::fill(image.plane(0), std::uint8_t{77});
  hal::Image result = scaled(image);
  for (std::size_t i = 0; i < result.plane(0).size(); ++i) {
    ASSERT_EQ(result.plane(0)[i], i % 4 == 3 ? 255 : 77) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Scales, ResamplerScalingTest, testing::ValuesIn(kScalings),
                         [](const testing::TestParamInfo<Scaling>& scaling) {
                           return scaling.param.name;
                         });

TEST_F(ResamplerTest, IsTheMeanOfTheAreaWhenAPictureShrinks) {
  Resampler resampler{ShaderLibrary{}};
  for (const FrameSize size : {FrameSize{100, 75}, FrameSize{60, 45}, FrameSize{27, 20}}) {
    const hal::Image image = wavyImage({200, 150});
    hal::Image result = readRgba8(resampler.resample(textureOf(image.view()), size));
    EXPECT_LE(largestError(result, resampledByArea(oracles::rgbOf(image.view()), size)), kTolerance)
        << size.width;
  }
}

TEST_F(ResamplerTest, GivesThePictureItselfWhereTheSizeIsRight) {
  Resampler resampler{ShaderLibrary{}};
  const Texture picture(TextureFormat::kRgba8, {8, 6}, TextureFilter::kLinear);
  EXPECT_EQ(&resampler.resample(picture, {8, 6}), &picture);
  EXPECT_NE(&resampler.resample(picture, {4, 3}), &picture);
}

}  // namespace
}  // namespace pleinair::gpu
