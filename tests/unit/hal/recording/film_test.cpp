// Films as other programs write them: colours and pixel shapes come from the container.
#include <gtest/gtest.h>

#include "tests/support/av_movie.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using support::AvMovie;

TEST(Film, PixelsThatAreNotSquareAreStretched) {
  const support::TemporaryFolder folder;
  support::writeAvMovie(folder.path() / "wide.mkv", {.frames = 3, .pixelAspect = {3, 2}});
  const auto played = support::play(folder.path() / "wide.mkv");
  ASSERT_TRUE(played) << played.error().message();
  EXPECT_EQ(played->format.frame.size, (FrameSize{96, 48}));
  EXPECT_EQ(played->frames.size(), 3U);
}

TEST(Film, HdrIsToneMapped) {
  const support::TemporaryFolder folder;
  AvMovie film{.layout = AV_PIX_FMT_YUV420P10LE,
               .frames = 2,
               .primaries = AVCOL_PRI_BT2020,
               .transfer = AVCOL_TRC_SMPTE2084,
               .matrix = AVCOL_SPC_BT2020_NCL};
  // 0.5 of PQ is 92 cd/m², 0.70 of sRGB's signal where white is at 203; as SDR it would be 0.5.
  film.draw = [](AVFrame& frame, int) {
    for (int plane = 0; plane < 3; ++plane) {
      for (int y = 0; y < (plane == 0 ? frame.height : frame.height / 2); ++y) {
        auto* const row = reinterpret_cast<std::uint16_t*>(
            frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane]);
        std::fill_n(row, plane == 0 ? frame.width : frame.width / 2,
                    static_cast<std::uint16_t>(plane == 0 ? 64 + 438 : 512));
      }
    }
  };
  support::writeAvMovie(folder.path() / "hdr.mkv", film);
  const auto played = support::play(folder.path() / "hdr.mkv");
  ASSERT_TRUE(played) << played.error().message();
  ASSERT_EQ(played->format.frame.pixelFormat, PixelFormat::kRgb8);
  EXPECT_NEAR(played->frames[0].image.map().view().row(0, 10)[30], 0.70 * 255, 3);
}

}  // namespace
}  // namespace pleinair::hal
