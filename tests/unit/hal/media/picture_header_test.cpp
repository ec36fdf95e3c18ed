#include "hal/media/picture_header.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::hal::libav {
namespace {

using std::string_literals::operator""s;

std::vector<std::uint8_t> bytesOf(const std::string& text) {
  return {text.begin(), text.end()};
}

const std::string kJpegStart = "\xFF\xD8\xFF\xE0\x00\x04xy"s;
const std::string kJpegFrame = "\xFF\xC2\x00\x0B\x08\xFF\xFE\x80\x01\x01\x01\x11\x00"s;
const std::string kJpegScan = "\xFF\xDA\x00\x08\x01\x01\x00\x00\x3F\x00"s;

TEST(PictureHeader, GivesTheSizeOfEachKind) {
  struct Case {
    PictureKind kind;
    std::string bytes;
    FrameSize size;
  };
  const std::string webp = "RIFF\0\0\0\0WEBP"s;
  const std::vector<Case> cases = {
      {PictureKind::kPng,
       "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\x7f\xff\xff\xff\0\0\0\x02"s,
       {0x7FFFFFFF, 2}},
      {PictureKind::kPng,
       "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\xff\xff\xff\xff\0\0\0\x02"s,
       {0x7FFFFFFF, 2}},
      {PictureKind::kJpeg, kJpegStart + "\xFF"s + kJpegFrame, {0x8001, 0xFFFE}},
      {PictureKind::kBmp,
       "BM"s + std::string(12, '\0') + "\x28\0\0\0\x03\0\0\0\xFE\xFF\xFF\xFF"s,
       {3, 2}},
      {PictureKind::kWebp,
       webp + "VP8X"s + std::string(8, '\0') + "\xFF\xFF\xFF\x01\0\0"s,
       {1 << 24, 2}},
      {PictureKind::kWebp,
       webp + "VP8L"s + "\0\0\0\0\x2F\x02\x80\0\0"s + std::string(8, '\0'),
       {3, 3}},
      {PictureKind::kPnm, "P6 # 7\n 12\n34 255\n"s, {12, 34}},
  };
  for (const Case& picture : cases) {
    const std::vector<std::uint8_t> bytes = bytesOf(picture.bytes);
    EXPECT_EQ(pictureKindOf(bytes), picture.kind);
    EXPECT_EQ(peekPictureSize(picture.kind, bytes), picture.size) << picture.bytes;
    // No truncation makes it read past the end (checked by the address sanitizer).
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      const std::vector<std::uint8_t> cut(bytes.begin(),
                                          bytes.begin() + static_cast<std::ptrdiff_t>(length));
      peekPictureSize(picture.kind, cut);
      defectOf(picture.kind, cut);
    }
  }
}

TEST(PictureHeader, FindsTheEndOfAJpegNotThatOfItsThumbnail) {
  const std::string thumbnail = "\xFF\xE1\x00\x06\xFF\xD9\xFF\xD9"s;
  const std::string cut = kJpegStart + thumbnail + kJpegFrame + kJpegScan + "data\xFF\x00 more"s;
  EXPECT_TRUE(defectOf(PictureKind::kJpeg, bytesOf(cut)));
  EXPECT_FALSE(defectOf(PictureKind::kJpeg, bytesOf(cut + "\xFF\xD9"s)));
}

TEST(PictureHeader, NoSizeIsNotASize) {
  EXPECT_EQ(peekPictureSize(PictureKind::kJpeg, bytesOf(kJpegStart + kJpegScan)), std::nullopt);
  EXPECT_EQ(pictureKindOf(bytesOf("GIF89a")), std::nullopt);
  EXPECT_EQ(pictureKindOf({}), std::nullopt);
}

}  // namespace
}  // namespace pleinair::hal::libav
