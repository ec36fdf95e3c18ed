#include "hal/cameras/recording/movie_frames.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <string>
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

  /// Two frames, `broken` that no decoder takes, and ten more.
  std::filesystem::path movieBrokenWithin(int broken) const {
    // The index of a .mov is behind its frames, and stays.
    const std::filesystem::path movie = path("broken.mov");
    support::writeAvMovie(
        movie, {.coding = AV_CODEC_ID_MJPEG, .layout = AV_PIX_FMT_YUVJ420P, .frames = broken + 12});
    std::string bytes;
    {
      std::ifstream file(movie, std::ios::binary);
      bytes.assign(std::istreambuf_iterator<char>(file), {});
    }
    std::vector<std::size_t> begins;  // of each picture
    for (std::size_t at = bytes.find("\xff\xd8\xff"); at != std::string::npos;
         at = bytes.find("\xff\xd8\xff", at + 1)) {
      begins.push_back(at);
    }
    EXPECT_EQ(begins.size(), static_cast<std::size_t>(broken + 12));
    const std::size_t end = begins[static_cast<std::size_t>(broken) + 2];
    std::fill(bytes.begin() + static_cast<std::ptrdiff_t>(begins[2]),
              bytes.begin() + static_cast<std::ptrdiff_t>(end), '\0');
    std::ofstream(movie, std::ios::binary) << bytes;
    return movie;
  }

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

TEST_F(MovieFrames, EndAfterTooManyBrokenOnes) {
  int count = 0;
  const auto take = [&](const ImageView&, Duration) {
    ++count;
    return true;
  };
  ASSERT_TRUE(forMovieFrames(movieBrokenWithin(100), {}, take));
  EXPECT_EQ(count, 12) << "a few are left out";
  count = 0;
  ASSERT_TRUE(forMovieFrames(movieBrokenWithin(300), {}, take));
  EXPECT_EQ(count, 2) << "nobody waits for what may come";
}

TEST_F(MovieFrames, EndAmongBrokenOnesWhereTheyAreNotWantedAnyMore) {
  int taken = 0;
  int asked = 0;
  ASSERT_TRUE(forMovieFrames(
      movieBrokenWithin(100), {},
      [&](const ImageView&, Duration) {
        ++taken;
        return true;
      },
      [&] { return ++asked > 50; }));
  EXPECT_EQ(taken, 2);
  EXPECT_EQ(asked, 51);
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
