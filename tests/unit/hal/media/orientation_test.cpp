#include "hal/media/orientation.h"

#include <array>
#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/turned_pictures.h"

namespace pleinair::hal::libav {
namespace {

using Matrix = std::array<std::int32_t, 9>;

TEST(Orientation, TurnsEachFormatAndSizeInAllEightWays) {
  for (const PixelFormat format :
       {PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kNv12, PixelFormat::kI420}) {
    for (const FrameSize size :
         {FrameSize{6, 4}, FrameSize{5, 3}, FrameSize{1, 2}, FrameSize{1, 1}, FrameSize{131, 70}}) {
      const Image stored = support::unevenPicture({.pixelFormat = format, .size = size});
      for (const auto& [number, matrix] : support::kOrientations) {
        const Orientation orientation = orientationOf(support::displayMatrix(matrix));
        EXPECT_EQ(orientation.isUpright(), number == 1);
        const Image shown = oriented(stored.view(), orientation);
        const Image expected = support::uprightByExif(stored.view(), number);
        ASSERT_EQ(shown.size(), expected.size());
        EXPECT_EQ(shown.size(), oriented(size, orientation));
        EXPECT_TRUE(support::equalPixels(shown.view(), expected.view()))
            << toString(format) << ' ' << size.width << 'x' << size.height << ' ' << number;
      }
    }
  }
}

TEST(Orientation, ReadsRowsThatAreNotPacked) {
  const std::array<std::uint8_t, 8> bytes = {1, 2, 3, 99, 4, 5, 6, 99};
  ImageView stored{.format = {.pixelFormat = PixelFormat::kGrey8, .size = {3, 2}}, .planes = {}};
  stored.planes[0] = {.bytes = std::span(bytes).first(7), .strideBytes = 4};
  const Image shown =
      oriented(stored, {.transposed = true, .fromRight = false, .fromBottom = true});
  const std::array<std::uint8_t, 6> clockwise = {4, 1, 5, 2, 6, 3};
  EXPECT_TRUE(std::ranges::equal(shown.view().planes[0].bytes, clockwise));
}

TEST(Orientation, OfAMatrixThatScalesMovesAndRoundsIsThatOfItsTurn) {
  constexpr int kOne = 1 << 16;
  const Matrix matrix = {40, 2 * kOne, 0, -kOne, -90, 0, 96 * kOne, 0, 1 << 30};
  EXPECT_EQ(orientationOf(matrix),
            (Orientation{.transposed = true, .fromRight = false, .fromBottom = true}));
}

TEST(Orientation, OtherAnglesAndBrokenMatricesAreIgnored) {
  constexpr int kHalf = 1 << 15;
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  for (const Matrix& matrix : {Matrix{},                                  // all zero
                               Matrix{-kHalf, kHalf, 0, -kHalf, -kHalf},  // 135°
                               Matrix{-kHalf, kHalf / 28, 0, 0, -kHalf},  // 178°
                               Matrix{-kHalf, 0, 0, 0, 0},                // flat
                               Matrix{kLeast, kLeast, 0, kLeast, kLeast}}) {
    EXPECT_TRUE(orientationOf(matrix).isUpright()) << matrix[0] << ' ' << matrix[1];
  }
}

}  // namespace
}  // namespace pleinair::hal::libav
