// A part of a recording, from one time to another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/av_movie.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;

constexpr int kMovieFrames = 50;  // at 25 a second, a key frame every second in .mkv

/// Luma of the frame's number in a movie of support::writeAvMovie().
int lumaOf(const CapturedFrame& frame) {
  return frame.image.map().view().row(0, 5)[5];
}

class Part : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    path_ = folder_.path() / GetParam();
    const bool isMp4 = path_.extension() == ".mp4";
    support::writeAvMovie(
        path_, {.coding = isMp4 ? AV_CODEC_ID_MPEG4 : AV_CODEC_ID_FFV1, .frames = kMovieFrames});
  }
  support::TemporaryFolder folder_;
  std::filesystem::path path_;
};

TEST_P(Part, BeginsAndEndsAtItsTimes) {
  const auto whole = support::play(path_);
  ASSERT_TRUE(whole);
  ASSERT_EQ(whole->frames.size(), static_cast<std::size_t>(kMovieFrames));
  const auto part = support::play(path_, {.from = 1400ms, .to = 1800ms});
  ASSERT_TRUE(part) << part.error().message();
  ASSERT_EQ(part->frames.size(), 10U);
  EXPECT_EQ(part->times.front(), 0ms);
  EXPECT_EQ(part->times.back(), 360ms);
  for (std::size_t i = 0; i < part->frames.size(); ++i) {
    EXPECT_EQ(lumaOf(part->frames[i]), lumaOf(whole->frames[35 + i])) << i;
  }
  const auto* end = std::get_if<EndOfStream>(&part->ending);
  ASSERT_NE(end, nullptr);
  EXPECT_FALSE(end->truncated);
  EXPECT_EQ(part->dropped, 0U);
}

TEST_P(Part, GoesOnToTheEnd) {
  const auto part = support::play(path_, {.from = 1900ms});
  ASSERT_TRUE(part) << part.error().message();
  EXPECT_EQ(part->frames.size(), 2U);
  const auto* end = std::get_if<EndOfStream>(&part->ending);
  ASSERT_NE(end, nullptr);
  EXPECT_FALSE(end->truncated) << end->truncated->message();
}

TEST_P(Part, BeyondTheEndIsAnError) {
  const auto part = support::play(path_, {.from = 10s});
  ASSERT_FALSE(part);
  EXPECT_EQ(part.error().problem, "has no valid frame in the part that was asked for");
  EXPECT_THAT(part.error().remedy, testing::HasSubstr("its time begins at 0 and ends at 2 s"));
}

INSTANTIATE_TEST_SUITE_P(Containers, Part, testing::Values("a.mkv", "a.mp4"));

TEST(PartOfAFolder, CountsInPeriods) {
  const support::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "in");
  support::writeMedia(folder.path() / "in/", 10);
  const auto part =
      support::play(folder.path() / "in", {.picturePeriod = 100ms, .from = 250ms, .to = 600ms});
  ASSERT_TRUE(part);
  EXPECT_EQ(part->frames.size(), 3U) << "0.3, 0.4 and 0.5 s";
  EXPECT_EQ(part->format.frameCount, 3U);
}

TEST(PartOfAFolder, BeyondTheEndIsAnErrorWithTheLength) {
  const support::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "in");
  support::writeMedia(folder.path() / "in/", 10);
  const auto part = support::play(folder.path() / "in", {.picturePeriod = 100ms, .from = 10s});
  ASSERT_FALSE(part);
  EXPECT_THAT(part.error().remedy, testing::HasSubstr("its time begins at 0 and ends at 1 s"));
}

TEST(PartOfAFolder, TellsWhichPicturesAreLeftOut) {
  const support::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "in");
  support::writeMedia(folder.path() / "in/", 3);
  std::filesystem::resize_file(folder.path() / "in/000001.png", 60);
  std::vector<std::string> skipped;
  const auto played =
      support::play(folder.path() / "in",
                    {.onSkipped = [&](const Error& error) { skipped.push_back(error.subject); }});
  ASSERT_TRUE(played);
  EXPECT_EQ(played->frames.size(), 2U);
  EXPECT_EQ(skipped, std::vector<std::string>{(folder.path() / "in/000001.png").string()});
}

}  // namespace
}  // namespace pleinair::hal
