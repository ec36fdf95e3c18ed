// Movies with a display matrix and JPEGs with an EXIF orientation are delivered upright.
#include <algorithm>
#include <array>
#include <bit>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

#include <gtest/gtest.h>

#include "hal/media/handles.h"
#include "hal/media/picture_file.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/turned_pictures.h"

namespace pleinair::hal {
namespace {

namespace fs = std::filesystem;

std::string contentsOf(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void write(const fs::path& path, std::string_view bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The MP4 with the matrix of its only track replaced (ISO/IEC 14496-12 §8.3.2).
std::string withMatrix(std::string mp4, std::array<int, 4> matrix) {
  const std::size_t type = mp4.find("tkhd");
  if (type == std::string::npos) throw std::runtime_error("the movie has no track header");
  const bool wideTimes = mp4.at(type + 4) == 1;
  std::size_t at = type + 4 + (wideTimes ? 52 : 40);
  for (const std::int32_t entry : support::displayMatrix(matrix)) {
    for (int shift = 24; shift >= 0; shift -= 8) {
      mp4.at(at++) = static_cast<char>(std::bit_cast<std::uint32_t>(entry) >> shift);
    }
  }
  return mp4;
}

/// A JPEG of the luma and chroma of `picture` (I420, full range).
std::string jpegOf(const Image& picture) {
  auto encoder = libav::owned<libav::CodecContext>(
      avcodec_alloc_context3(avcodec_find_encoder(AV_CODEC_ID_MJPEG)));
  const libav::Frame frame = libav::makeFrame();
  encoder->width = frame->width = picture.size().width;
  encoder->height = frame->height = picture.size().height;
  encoder->pix_fmt = AV_PIX_FMT_YUVJ420P;
  frame->format = AV_PIX_FMT_YUVJ420P;
  encoder->time_base = {1, 25};
  const libav::Packet packet = libav::makePacket();
  if (avcodec_open2(encoder.get(), encoder->codec, nullptr) < 0 ||
      av_frame_get_buffer(frame.get(), 0) < 0) {
    throw std::runtime_error("no JPEG encoder");
  }
  for (int plane = 0; plane < 3; ++plane) {
    for (int y = 0; y < planeRows(PixelFormat::kI420, plane, picture.size().height); ++y) {
      std::ranges::copy(picture.view().row(plane, y),
                        frame->data[plane] + std::ptrdiff_t{y} * frame->linesize[plane]);
    }
  }
  if (avcodec_send_frame(encoder.get(), frame.get()) < 0 ||
      avcodec_receive_packet(encoder.get(), packet.get()) < 0) {
    throw std::runtime_error("cannot encode a JPEG");
  }
  return {reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size)};
}

/// Adds an EXIF segment with one tag at the front of the JPEG.
std::string withExif(std::string jpeg, int orientation) {
  using std::string_literals::operator""s;
  const std::string exif = "Exif\0\0MM\0\x2A\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0"s +
                           static_cast<char>(orientation) + "\0\0\0\0\0\0"s;
  const std::string header = "\xFF\xE1\0"s + static_cast<char>(exif.size() + 2);
  return jpeg.insert(2, header + exif);
}

/// Its size is odd, so that the last row and column of chroma cover one pixel.
std::string storedJpeg() {
  return jpegOf(support::testPicture({.pixelFormat = PixelFormat::kI420, .size = {37, 21}}, 3));
}

TEST(MovieOrientation, TurnsFramesInAllEightWays) {
  const support::TemporaryFolder folder;
  const fs::path path = folder.path() / "a.mp4";
  support::writeMedia(path, 3);
  const std::string movie = contentsOf(path);
  const support::Played stored = orThrow(support::play(path));
  ASSERT_EQ(stored.frames.size(), 3u);
  for (const auto& [number, matrix] : support::kOrientations) {
    write(path, withMatrix(movie, matrix));
    const Result<support::Played> played = support::play(path);
    ASSERT_TRUE(played) << played.error().message();
    EXPECT_TRUE(played->changes.empty());
    ASSERT_EQ(played->frames.size(), stored.frames.size());
    for (std::size_t i = 0; i < stored.frames.size(); ++i) {
      const Image expected = support::uprightByExif(stored.frames[i].image.map().view(), number);
      EXPECT_EQ(played->format.frame, expected.format()) << number;
      EXPECT_TRUE(support::equalPixels(played->frames[i].image.map().view(), expected.view()))
          << number;
    }
    EXPECT_EQ(played->times, stored.times);
  }
}

TEST(MovieOrientation, OtherAnglesAreIgnored) {
  const support::TemporaryFolder folder;
  const fs::path path = folder.path() / "a.mp4";
  const FrameFormat format = support::writeMedia(path, 1);
  write(path, withMatrix(contentsOf(path), {1, 1, -1, 1}));
  EXPECT_EQ(orThrow(support::play(path)).format.frame.size, format.size);
}

TEST(MovieOrientation, PhoneMovieStandsUpright) {
  const fs::path phone = fs::path(PLEINAIR_SHARED_DATA) / "malformed/video/valid_rotate90.mp4";
  if (!fs::exists(phone)) GTEST_SKIP() << "test data is not here: " << phone;
  const support::TemporaryFolder folder;
  const fs::path lying = folder.path() / "lying.mp4";
  write(lying, withMatrix(contentsOf(phone), {1, 0, 0, 1}));
  const support::Played stored = orThrow(support::play(lying));
  ASSERT_EQ(stored.format.frame.size, (FrameSize{128, 96}));
  const support::Played upright = orThrow(support::play(phone));
  EXPECT_EQ(upright.format.frame.size, (FrameSize{96, 128}));
  ASSERT_EQ(upright.frames.size(), 30u);
  ASSERT_EQ(stored.frames.size(), 30u);
  constexpr int kQuarterTurnAgainstTheClock = 8;
  for (std::size_t i = 0; i < stored.frames.size(); ++i) {
    const Image expected =
        support::uprightByExif(stored.frames[i].image.map().view(), kQuarterTurnAgainstTheClock);
    EXPECT_TRUE(support::equalPixels(upright.frames[i].image.map().view(), expected.view())) << i;
  }
}

TEST(PictureOrientation, TurnsJpegsInAllEightWays) {
  const support::TemporaryFolder folder;
  const fs::path path = folder.path() / "a.jpg";
  const std::string jpeg = storedJpeg();
  write(path, jpeg);
  const Image stored = orThrow(readPicture(path));
  ASSERT_EQ(stored.format().pixelFormat, PixelFormat::kI420);
  const Image storedRgb = orThrow(readPictureRgb(path));
  for (const auto& [number, matrix] : support::kOrientations) {
    write(path, withExif(jpeg, number));
    const Result<Image> shown = readPicture(path);
    ASSERT_TRUE(shown) << shown.error().message();
    const Image expected = support::uprightByExif(stored.view(), number);
    EXPECT_EQ(shown->size(), expected.size()) << number;
    EXPECT_TRUE(support::equalPixels(shown->view(), expected.view())) << number;
    EXPECT_TRUE(support::equalPixels(orThrow(readPictureRgb(path)).view(),
                                     support::uprightByExif(storedRgb.view(), number).view()))
        << number;
  }
}

TEST(PictureOrientation, NumbersThatExifHasNotAreIgnored) {
  const support::TemporaryFolder folder;
  const fs::path path = folder.path() / "a.jpg";
  for (const int number : {0, 9}) {
    write(path, withExif(storedJpeg(), number));
    EXPECT_EQ(orThrow(readPicture(path)).size(), (FrameSize{37, 21})) << number;
  }
}

TEST(PictureOrientation, ChangesTheFormatWithinAFolder) {
  const support::TemporaryFolder folder;
  write(folder.path() / "1.jpg", withExif(storedJpeg(), 6));
  write(folder.path() / "2.jpg", storedJpeg());
  const support::Played played = orThrow(support::play(folder.path()));
  EXPECT_EQ(played.format.frame.size, (FrameSize{21, 37}));
  ASSERT_EQ(played.changes.size(), 1u);
  EXPECT_EQ(played.changes[0].frame.size, (FrameSize{37, 21}));
  ASSERT_EQ(played.frames.size(), 2u);
}

}  // namespace
}  // namespace pleinair::hal
