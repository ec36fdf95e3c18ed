#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "hal/outputs/headless/headless_output.h"
#include "tests/support/test_pictures.h"

namespace pleinair::hal {
namespace {

TEST(HeadlessOutput, HashesPixelsAndFormatButNotPadding) {
  const FrameFormat format{.pixelFormat = PixelFormat::kRgb8, .size = {5, 3}};
  Image picture = support::testPicture(format, 0);
  const std::uint64_t hash = hashOf(picture.view());

  std::vector<std::uint8_t> padded(20 * 3, 0xEE);
  for (int y = 0; y < 3; ++y) std::ranges::copy(picture.row(0, y), padded.begin() + 20 * y);
  EXPECT_EQ(hashOf({.format = format, .planes = {{{.bytes = padded, .strideBytes = 20}}}}), hash);

  picture.plane(0).back() ^= 0x80;
  EXPECT_NE(hashOf(picture.view()), hash);
  EXPECT_NE(hashOf(Image({.pixelFormat = PixelFormat::kGrey8, .size = {15, 3}}).view()),
            hashOf(Image({.pixelFormat = PixelFormat::kRgb8, .size = {5, 3}}).view()));
}

TEST(HeadlessOutput, CountsAndKeepsOrder) {
  std::uint64_t running[2] = {};
  for (const int swapped : {0, 1}) {
    HeadlessOutput output;
    const FrameFormat format = orThrow(output.start({.size = {8, 8}})).frame;
    for (const int i : {0, 1}) {
      const Image picture = support::testPicture(format, i ^ swapped);
      EXPECT_TRUE(output.write(picture.view(), Duration(i)));
    }
    EXPECT_EQ(output.count(), 2u);
    EXPECT_NE(output.hashes()[0], output.hashes()[1]);
    running[swapped] = output.runningHash();
  }
  EXPECT_NE(running[0], running[1]);
}

}  // namespace
}  // namespace pleinair::hal
