#include "hal/cameras/recording/movie_frames.h"

#include <chrono>
#include <fstream>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/av_movie.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;

class MovieFrames : public testing::Test {
 protected:
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  support::TemporaryFolder folder_;
};

TEST_F(MovieFrames, AreRgbAtTheirTimes) {
  support::writeAvMovie(path("m.mkv"), {.size = {64, 48}, .frames = 10, .framesPerSecond = 10});
  std::vector<Duration> times;
  std::vector<int> greys;
  const auto read = forMovieFrames(path("m.mkv"), {}, [&](const ImageView& rgb, Duration time) {
    EXPECT_EQ(rgb.format.pixelFormat, PixelFormat::kRgb8);
    EXPECT_EQ(rgb.format.size, (FrameSize{64, 48}));
    times.push_back(time);
    greys.push_back(rgb.row(0, 20)[60]);
    return true;
  });
  ASSERT_TRUE(read) << read.error().message();
  ASSERT_EQ(times.size(), 10U);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_EQ(times[i], i * 100ms);
  EXPECT_GT(greys.back(), greys.front());
}

TEST_F(MovieFrames, BeginLaterAndEndWhereItIsSaid) {
  support::writeAvMovie(path("m.mkv"), {.frames = 10, .framesPerSecond = 10});
  int count = 0;
  ASSERT_TRUE(forMovieFrames(path("m.mkv"), 700ms, [&](const ImageView&, Duration) {
    ++count;
    return true;
  }));
  EXPECT_EQ(count, 3);
  count = 0;
  ASSERT_TRUE(
      forMovieFrames(path("m.mkv"), {}, [&](const ImageView&, Duration) { return ++count < 4; }));
  EXPECT_EQ(count, 4);
}

TEST_F(MovieFrames, WhatIsNoMovieIsSaid) {
  const auto none = [](const ImageView&, Duration) { return true; };
  EXPECT_EQ(forMovieFrames(path("none.mkv"), {}, none).error().kind, ErrorKind::kNotFound);
  std::ofstream(path("text.mkv")) << "no movie";
  EXPECT_EQ(forMovieFrames(path("text.mkv"), {}, none).error().kind, ErrorKind::kInvalidInput);
  support::writeAvMovie(path("m.mkv"), {.frames = 10, .framesPerSecond = 10});
  EXPECT_EQ(forMovieFrames(path("m.mkv"), 5s, none).error().kind, ErrorKind::kInvalidInput)
      << "beyond its end";
}

}  // namespace
}  // namespace pleinair::hal
