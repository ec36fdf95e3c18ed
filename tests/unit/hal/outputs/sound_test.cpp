// The sound of a recording in its painting.
#include <fstream>
#include <iterator>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/outputs/movie/movie_output.h"
#include "tests/support/av_movie.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// What the issue of everyday use allows, in seconds.
constexpr double kInStep = 0.020;

class Sound : public testing::Test {
 protected:
  std::filesystem::path path(const char* name) const { return folder_.path() / name; }

  void writeRecording(const char* name, AVCodecID video, AVCodecID sound) const {
    support::writeAvMovie(
        path(name),
        {.coding = video, .frames = 75, .soundCoding = sound, .clicksSeconds = {0.52, 1.30, 2.71}});
  }

  /// Writes so many frames of a painting with the recording's sound.
  void paint(const char* output, MovieOptions options, int frames) {
    options.onNotice = [this](const std::string& notice) { notices_.push_back(notice); };
    const auto movie = openMovieOutput(path(output), std::move(options));
    const auto format = orThrow(movie->start({.size = {64, 48}, .framePeriod = 40ms}));
    for (int i = 0; i < frames; ++i) {
      orThrow(movie->write(support::testPicture(format.frame, i).view(), i * 40ms));
    }
    orThrow(movie->finish());
  }

  void expectClicks(const char* output, const std::vector<double>& expected) const {
    const auto clicks = support::clicksIn(path(output));
    ASSERT_TRUE(clicks) << output << " has no sound";
    ASSERT_EQ(clicks->size(), expected.size()) << testing::PrintToString(*clicks);
    for (std::size_t i = 0; i < expected.size(); ++i) {
      EXPECT_NEAR((*clicks)[i], expected[i], kInStep) << output;
      RecordProperty("off_ms_" + std::to_string(i),
                     std::to_string(1000 * ((*clicks)[i] - expected[i])));
    }
  }

  support::TemporaryFolder folder_;
  std::vector<std::string> notices_;
};

TEST_F(Sound, IsKeptInStep) {
  writeRecording("in.mp4", AV_CODEC_ID_MPEG4, AV_CODEC_ID_AAC);
  writeRecording("in.mkv", AV_CODEC_ID_FFV1, AV_CODEC_ID_PCM_S16LE);
  paint("aac.mp4", {.soundOf = path("in.mp4")}, 75);
  paint("aac.mkv", {.soundOf = path("in.mp4")}, 75);
  paint("pcm.mkv", {.soundOf = path("in.mkv")}, 75);
  for (const char* output : {"aac.mp4", "aac.mkv", "pcm.mkv"}) {
    expectClicks(output, {0.52, 1.30, 2.71});
  }
  EXPECT_TRUE(notices_.empty());
}

TEST_F(Sound, OfARecordingThatIsCutWithinALaterHeadIsKeptUpToThere) {
  writeRecording("in.mp4", AV_CODEC_ID_MPEG4, AV_CODEC_ID_AAC);
  paint("whole.mp4", {.soundOf = path("in.mp4")}, 75);
  std::ifstream file(path("whole.mp4"), std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(file), {}};
  const std::size_t head = whole.rfind("moof");
  ASSERT_NE(head, whole.find("moof")) << "a control: it has several fragments";
  std::ofstream(path("cut.mp4"), std::ios::binary) << whole.substr(0, head + 60);
  paint("again.mp4", {.soundOf = path("cut.mp4")}, 40);
  expectClicks("again.mp4", {0.52, 1.30});
}

TEST_F(Sound, OfAPartBeginsWithItsFirstFrame) {
  writeRecording("in.mp4", AV_CODEC_ID_MPEG4, AV_CODEC_ID_AAC);
  // Between two frames: the part begins at 1.24 s.
  paint("part.mp4", {.soundOf = path("in.mp4"), .soundFrom = 1210ms}, 44);
  expectClicks("part.mp4", {1.30 - 1.24, 2.71 - 1.24});
}

TEST_F(Sound, EndsWithTheLastImage) {
  writeRecording("in.mkv", AV_CODEC_ID_FFV1, AV_CODEC_ID_PCM_S16LE);
  paint("short.mkv", {.soundOf = path("in.mkv")}, 40);
  expectClicks("short.mkv", {0.52, 1.30});
}

TEST_F(Sound, ThatTheFileCannotHoldBecomesAac) {
  writeRecording("in.mkv", AV_CODEC_ID_FFV1, AV_CODEC_ID_PCM_S16LE);
  paint("out.mp4", {.soundOf = path("in.mkv")}, 75);
  expectClicks("out.mp4", {0.52, 1.30, 2.71});
  paint("part.mp4", {.soundOf = path("in.mkv"), .soundFrom = 1210ms}, 44);
  expectClicks("part.mp4", {1.30 - 1.24, 2.71 - 1.24});
  paint("short.mp4", {.soundOf = path("in.mkv")}, 40);
  expectClicks("short.mp4", {0.52, 1.30});
  ASSERT_EQ(notices_.size(), 3U);
  EXPECT_THAT(notices_.front(),
              HasSubstr("holds no sound coded as pcm_s16le, which becomes AAC; an .mkv would"));
}

TEST_F(Sound, IsLeftOutOfY4mWithANotice) {
  writeRecording("in.mkv", AV_CODEC_ID_FFV1, AV_CODEC_ID_PCM_S16LE);
  paint("out.y4m", {.soundOf = path("in.mkv")}, 10);
  EXPECT_FALSE(support::clicksIn(path("out.y4m")));
  ASSERT_EQ(notices_.size(), 1U);
  EXPECT_THAT(notices_.front(),
              HasSubstr("out.y4m: holds no sound: that of the recording is left"));
}

TEST_F(Sound, OfASilentRecordingChangesNoByte) {
  support::writeAvMovie(path("in.mkv"), {.frames = 10});
  paint("with.mp4", {.soundOf = path("in.mkv")}, 10);
  paint("without.mp4", {}, 10);
  const auto bytes = [&](const char* name) {
    std::ifstream file(path(name), std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_TRUE(bytes("with.mp4") == bytes("without.mp4"));
  EXPECT_TRUE(notices_.empty());
}

}  // namespace
}  // namespace pleinair::hal
