#include "hal/frame_image.h"

#include <set>

#include <gtest/gtest.h>

namespace pleinair::hal {
namespace {

class CountedAccess final : public ReadAccess {
 public:
  void beginRead() const override { ++begun; }
  void endRead() const override { ++ended; }
  mutable int begun = 0, ended = 0;
};

class FrameImageTest : public testing::Test {
 protected:
  Image image_{FrameFormat{.pixelFormat = PixelFormat::kNv12, .size = {6, 4}}};
  CountedAccess access_;
};

TEST_F(FrameImageTest, IsReadBetweenTheBracketsOnly) {
  const FrameImage picture(image_.view(), &access_);
  EXPECT_TRUE(picture.isComplete());
  EXPECT_EQ(picture.strideBytes(1), 6u);
  EXPECT_EQ(access_.begun, 0) << "facts need no pixels";
  {
    const FrameMapping mapped = picture.map();
    EXPECT_EQ(access_.begun, 1);
    EXPECT_EQ(access_.ended, 0);
    EXPECT_EQ(mapped.view().planes[0].bytes.data(), image_.plane(0).data());
  }
  EXPECT_EQ(access_.ended, 1);
}

TEST_F(FrameImageTest, AMappingThatMovesEndsOnce) {
  const FrameImage picture(image_.view(), &access_);
  {
    FrameMapping first = picture.map();
    const FrameMapping second = std::move(first);
    EXPECT_EQ(access_.ended, 0);
  }
  EXPECT_EQ(access_.begun, 1);
  EXPECT_EQ(access_.ended, 1);
}

TEST_F(FrameImageTest, ACopyIsMadeWithinBrackets) {
  image_.plane(0)[3] = 77;
  const Image copy{FrameImage(image_.view(), &access_)};
  EXPECT_EQ(copy.view().row(0, 0)[3], 77);
  EXPECT_EQ(access_.begun, 1);
  EXPECT_EQ(access_.ended, 1);
}

TEST(BufferPools, HaveNumbersOfTheirOwn) {
  std::set<std::uint64_t> numbers;
  for (int i = 0; i < 100; ++i) numbers.insert(nextBufferPool());
  EXPECT_EQ(numbers.size(), 100u);
  EXPECT_FALSE(numbers.contains(0));
  EXPECT_FALSE(BufferIdentity{});
}

TEST(DrmNames, AreThoseOfTheLayouts) {
  EXPECT_EQ(drmFourccOf(PixelFormat::kNv12), 0x3231564EU);
  EXPECT_EQ(drmFourccOf(PixelFormat::kYuyv), 0x56595559U);
  EXPECT_EQ(drmFourccOf(PixelFormat::kGrey8), drmFourccOf(PixelFormat::kBayerRggb8));
}

}  // namespace
}  // namespace pleinair::hal
