#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "hal/media/picture_paths.h"
#include "hal/media/png_file.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_jpegs.h"

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

ErrorKind kindOfPlaying(const fs::path& path) {
  const Result<support::Played> played = support::play(path);
  EXPECT_FALSE(played) << path << " played";
  if (played) return ErrorKind::kInternal;
  EXPECT_THAT(played.error().message(), testing::HasSubstr(path.string()));
  return played.error().kind;
}

TEST(NaturalOrder, ComparesNumbersAsNumbers) {
  std::vector<std::string> names = {"a10", "a2", "b1", "a02", "a", "a2b", "a1"};
  std::ranges::sort(names, naturallyLess);
  EXPECT_THAT(names, testing::ElementsAre("a", "a1", "a02", "a2", "a2b", "a10", "b1"));
}

TEST(RecordingPath, ReadsTheFolderInOrderAndOnlyItsPictures) {
  const support::TemporaryFolder folder;
  for (const int i : {2, 10, 1}) {
    writePng(folder.path() / ("p" + std::to_string(i) + ".png"),
             Image({.pixelFormat = PixelFormat::kRgb8, .size = {i, 1}}).view());
  }
  fs::copy(folder.path() / "p2.png", folder.path() / "p3.PNG");
  std::ofstream(folder.path() / "notes.txt") << "not a picture";
  std::ofstream(folder.path() / ".p0.png") << "hidden";
  fs::create_directory(folder.path() / "p4.png");
  const Result<support::Played> played = support::play(folder.path());
  ASSERT_TRUE(played) << played.error().message();
  std::vector<int> widths;
  for (const CapturedFrame& frame : played->frames) widths.push_back(frame.image.format.size.width);
  EXPECT_THAT(widths, testing::ElementsAre(1, 2, 2, 10));
  EXPECT_EQ(played->changes.size(), 2u) << "each change of size is announced";
}

TEST(RecordingPath, PlaysMotionJpegWhateverTheCaseOfItsEnding) {
  const support::TemporaryFolder folder;
  const std::vector<std::uint8_t> jpeg = support::testJpeg("j420.jpg");
  for (const char* name : {"a.mjpg", "b.MJPG", "c.MJpeg"}) {
    std::ofstream file(folder.path() / name, std::ios::binary);
    for (int i = 0; i < 3; ++i) {
      file.write(reinterpret_cast<const char*>(jpeg.data()), std::ssize(jpeg));
    }
    file.close();
    const Result<support::Played> played = support::play(folder.path() / name);
    ASSERT_TRUE(played) << name << ": " << played.error().message();
    EXPECT_EQ(played->frames.size(), 3u) << name;
  }
}

TEST(RecordingPath, ReadsAPatternFromItsFirstNumberToTheGap) {
  const support::TemporaryFolder folder;
  const Image picture({.pixelFormat = PixelFormat::kRgb8, .size = {2, 2}});
  for (const char* name : {"05.png", "06.png", "07.png", "09.png", "6.png", "x07.png"}) {
    writePng(folder.path() / name, picture.view());
  }
  const Result<support::Played> played = support::play(folder.path() / "%02d.png");
  ASSERT_TRUE(played) << played.error().message();
  EXPECT_EQ(played->frames.size(), 3u);
  EXPECT_EQ(kindOfPlaying(folder.path() / "%03d.png"), ErrorKind::kNotFound);
  EXPECT_EQ(kindOfPlaying(folder.path() / "%s.png"), ErrorKind::kInvalidArgument);
  writePng(folder.path() / "100%.png", picture.view());
  EXPECT_TRUE(support::play(folder.path() / "100%.png")) << "a file that exists is no pattern";
}

TEST(RecordingPath, SaysWhatIsWrong) {
  const support::TemporaryFolder folder;
  EXPECT_EQ(kindOfPlaying(folder.path() / "missing.mp4"), ErrorKind::kNotFound);
  EXPECT_EQ(kindOfPlaying(folder.path() / "a" / "b.mp4"), ErrorKind::kNotFound);
  EXPECT_EQ(kindOfPlaying(folder.path()), ErrorKind::kInvalidInput) << "an empty folder";
  ASSERT_EQ(::mkfifo((folder.path() / "pipe.mp4").c_str(), 0600), 0);
  EXPECT_EQ(kindOfPlaying(folder.path() / "pipe.mp4"), ErrorKind::kInvalidInput);
  std::ofstream(folder.path() / "text.mp4") << "just some text, in no order\n";
  EXPECT_EQ(kindOfPlaying(folder.path() / "text.mp4"), ErrorKind::kInvalidInput);
}

TEST(RecordingPath, RefusesSizesBeyondTheLimitsFromTheHeader) {
  const support::TemporaryFolder folder;
  std::ofstream(folder.path() / "a.y4m") << "YUV4MPEG2 W8193 H16 F30:1 C420jpeg\nFRAME\n";
  std::ofstream(folder.path() / "b.y4m") << "YUV4MPEG2 W8192 H8192 F30:1 C420jpeg\nFRAME\n";
  std::ofstream(folder.path() / "c.ppm") << "P6 60000 60000 255\n";
  for (const char* name : {"a.y4m", "b.y4m", "c.ppm"}) {
    EXPECT_EQ(kindOfPlaying(folder.path() / name), ErrorKind::kUnsupported) << name;
  }
}

TEST(RecordingPath, IsNeverAUrlNorAPlaylist) {
  const support::TemporaryFolder folder;
  const fs::path movie = folder.path() / "a.mp4";
  support::writeMedia(movie, 2);
  EXPECT_EQ(kindOfPlaying("file:" + movie.string()), ErrorKind::kNotFound);
  EXPECT_EQ(kindOfPlaying("concat:" + movie.string()), ErrorKind::kNotFound);
  EXPECT_EQ(kindOfPlaying("http://127.0.0.1:1/a.mp4"), ErrorKind::kNotFound);

  std::ofstream(folder.path() / "list.txt") << "ffconcat version 1.0\nfile a.mp4\n";
  std::ofstream(folder.path() / "hls.m3u8")
      << "#EXTM3U\n#EXT-X-VERSION:3\n#EXT-X-TARGETDURATION:1\n"
         "#EXTINF:1,\na.mp4\n#EXT-X-ENDLIST\n";
  std::ofstream(folder.path() / "a.sdp")
      << "v=0\no=- 0 0 IN IP4 127.0.0.1\ns=x\nc=IN IP4 127.0.0.1\n"
         "t=0 0\nm=video 5000 RTP/AVP 96\na=rtpmap:96 H264/90000\n";
  for (const char* name : {"list.txt", "hls.m3u8", "a.sdp"}) {
    EXPECT_EQ(kindOfPlaying(folder.path() / name), ErrorKind::kInvalidInput) << name;
  }
}

}  // namespace
}  // namespace pleinair::hal
