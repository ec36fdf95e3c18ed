#include "firmware_app/overlay/step_movie.h"

#include <chrono>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

#include "firmware_app/overlay/step_content.h"
#include "pipeline/overlay/movie_player.h"
#include "tests/support/av_movie.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::app {
namespace {

using namespace std::chrono_literals;

std::size_t bytesOf(const overlay::PanelMovie& movie) {
  std::size_t bytes = 0;
  for (const auto& each : movie.frames) bytes += each.image.view().planes[0].bytes.size();
  return bytes;
}

class StepMovieTest : public testing::Test {
 protected:
  std::filesystem::path write(const support::AvMovie& movie) const {
    const std::filesystem::path path = folder_.path() / "m.mkv";
    support::writeAvMovie(path, movie);
    return path;
  }

  /// Null where it cannot be read.
  static std::shared_ptr<const overlay::PanelMovie> read(const std::filesystem::path& file,
                                                         hal::FrameSize place) {
    return readStepMovie(file, place).value_or(nullptr);
  }

  support::TemporaryFolder folder_;
};

TEST_F(StepMovieTest, HasTheSizeOfItsPlaceAndAtMostTwelveFramesASecond) {
  const auto movie =
      read(write({.size = {160, 90}, .frames = 50, .framesPerSecond = 25}), {80, 45});
  ASSERT_NE(movie, nullptr);
  EXPECT_EQ(movie->frames.front().image.size(), (hal::FrameSize{80, 45}));
  EXPECT_EQ(movie->frames.front().begins, 0ms);
  EXPECT_EQ(movie->frames.size(), 25U);
  EXPECT_EQ(movie->length, 2s);
}

TEST_F(StepMovieTest, KeepsAllFramesOfASlowOne) {
  const auto movie = read(write({.frames = 6, .framesPerSecond = 5}), {64, 48});
  ASSERT_NE(movie, nullptr);
  EXPECT_EQ(movie->frames.size(), 6U);
  EXPECT_EQ(movie->length, 1200ms);
}

TEST_F(StepMovieTest, TakesBoundedMemoryHoweverLargeItsPlaceIs) {
  const auto file = write({.size = {64, 36}, .frames = 15 * 25 + 100, .framesPerSecond = 25});
  const auto movie = read(file, {1792, 1008});
  ASSERT_NE(movie, nullptr);
  EXPECT_LE(movie->length, 15s) << "more is not taken";
  EXPECT_LE(bytesOf(*movie), kMostMovieBytes);
  EXPECT_GE(bytesOf(*movie), kMostMovieBytes * 9 / 10) << "as large as that lets it be";
  const hal::FrameSize size = movie->frames.front().image.size();
  EXPECT_NEAR(size.width / static_cast<double>(size.height), 16.0 / 9.0, 0.02);
}

TEST_F(StepMovieTest, IsNoneWhereTheFileIsGoneOrItIsNotWantedAnyMore) {
  const auto gone = readStepMovie(folder_.path() / "none.mkv", {64, 48});
  ASSERT_FALSE(gone);
  EXPECT_EQ(gone.error().kind, hal::ErrorKind::kNotFound);
  std::stop_source source;
  source.request_stop();
  const auto unwanted = readStepMovie(write({}), {64, 48}, source.get_token());
  ASSERT_TRUE(unwanted);
  EXPECT_EQ(*unwanted, nullptr);
}

TEST_F(StepMovieTest, InPlaceOfAnUnreadableOneATextSaysSo) {
  procedure::Procedure procedure;
  procedure.languages = {"de"};
  procedure.steps.resize(1);
  procedure.steps[0].id = "turn";
  procedure.steps[0].movie = procedure::StepMovie{.file = "gone.mkv", .size = {160, 90}};
  const StepShown shown{.procedure = std::make_shared<const procedure::Procedure>(procedure),
                        .language = "de"};
  for (const hal::FrameSize place : {hal::FrameSize{160, 90}, {40, 22}, {1, 1}}) {
    const auto movie = stepMovie(shown, folder_.path(), {.topLeft = {}, .size = place});
    ASSERT_NE(movie, nullptr);
    ASSERT_EQ(movie->frames.size(), 1U);
    const hal::Image& image = movie->frames.front().image;
    ASSERT_EQ(image.size(), place);
    if (place.width < 160) continue;  // little is legible there
    int bright = 0;
    for (int y = 0; y < place.height; ++y) {
      for (const std::uint8_t each : image.view().row(0, y)) bright += each > 150 ? 1 : 0;
    }
    EXPECT_GT(bright, 100) << "letters";
  }
  std::stop_source source;
  source.request_stop();
  EXPECT_EQ(
      stepMovie(shown, folder_.path(), {.topLeft = {}, .size = {160, 90}}, source.get_token()),
      nullptr);
}

TEST_F(StepMovieTest, ASizeOfRowsIsBounded) {
  EXPECT_EQ(sizeOfRows({160, 90}, 45), (hal::FrameSize{80, 45}));
  EXPECT_EQ(sizeOfRows({160, 90}, 45, 40), (hal::FrameSize{40, 22}));
  EXPECT_EQ(sizeOfRows({8192, 1}, 4000), (hal::FrameSize{hal::kMaxSidePixels, 1}));
  EXPECT_EQ(sizeOfRows({1, 8192}, 96), (hal::FrameSize{1, 96}));
}

TEST_F(StepMovieTest, ThePosterIsItsFirstFrameWithASign) {
  const auto file = write(
      {.size = {160, 90}, .draw = [](AVFrame& frame, int number) {
         for (int y = 0; y < frame.height; ++y) {
           std::fill_n(frame.data[0] + y * frame.linesize[0], frame.width, number == 0 ? 120 : 200);
         }
         for (int plane = 1; plane < 3; ++plane) {
           for (int y = 0; y < frame.height / 2; ++y) {
             std::fill_n(frame.data[plane] + y * frame.linesize[plane], frame.width / 2, 128);
           }
         }
       }});
  const auto poster = moviePoster(file, 96);
  ASSERT_TRUE(poster);
  EXPECT_EQ(poster->size(), (hal::FrameSize{170, 96}));
  const auto row = poster->view().row(0, 48);
  EXPECT_NEAR(row[3 * 10], 122, 5) << "the first frame";
  EXPECT_GT(row[3 * 85], 240) << "the sign";
}

TEST(PanelMovie, ShowsTheFrameOfItsTimeAgainAndAgain) {
  overlay::PanelMovie movie{.frames = {}, .length = 250ms};
  for (const hal::Duration begins : {0ms, 100ms, 180ms}) {
    movie.frames.push_back({.begins = begins, .image = {}});
  }
  EXPECT_EQ(overlay::frameAt(movie, 0ms), 0U);
  EXPECT_EQ(overlay::frameAt(movie, 99ms), 0U);
  EXPECT_EQ(overlay::frameAt(movie, 100ms), 1U);
  EXPECT_EQ(overlay::frameAt(movie, 249ms), 2U);
  EXPECT_EQ(overlay::frameAt(movie, 250ms), 0U) << "from its beginning";
  EXPECT_EQ(overlay::frameAt(movie, 1h + 100ms), overlay::frameAt(movie, (1h + 100ms) % 250ms));
  EXPECT_EQ(overlay::frameAt(movie, -70ms), 0U) << "a time before its beginning";
}

}  // namespace
}  // namespace pleinair::app
