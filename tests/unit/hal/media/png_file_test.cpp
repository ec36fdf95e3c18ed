#include "hal/media/png_file.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

class OwnPng : public testing::Test {
 protected:
  static Image picture(PixelFormat format, FrameSize size = {37, 11}) {
    Image image({.pixelFormat = format, .size = size, .encoding = {}});
    std::uint8_t value = 1;
    for (int y = 0; y < size.height; ++y) {
      for (std::uint8_t& byte : image.row(0, y))
        byte = value = static_cast<std::uint8_t>(value * 29 + 7);
    }
    return image;
  }
  std::string file() const { return (folder_.path() / "own.png").string(); }
  void write(const std::vector<std::uint8_t>& bytes) const {
    std::ofstream(file(), std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  support::TemporaryFolder folder_;
};

TEST_F(OwnPng, IsReadAsItWasWritten) {
  const Image written = picture(PixelFormat::kRgb8);
  ASSERT_TRUE(writePng(file(), written.view()));
  const Result<Image> read = readOwnPng(file());
  ASSERT_TRUE(read) << read.error().problem;
  ASSERT_EQ(read->size(), written.size());
  for (int y = 0; y < written.size().height; ++y) {
    EXPECT_TRUE(std::ranges::equal(read->view().row(0, y), written.view().row(0, y))) << y;
  }
}

TEST_F(OwnPng, OfGreyBecomesRgb) {
  const Image written = picture(PixelFormat::kGrey8, {5, 3});
  ASSERT_TRUE(writePng(file(), written.view()));
  const Result<Image> read = readOwnPng(file());
  ASSERT_TRUE(read) << read.error().problem;
  EXPECT_EQ(read->view().row(0, 2)[3 * 4 + 1], written.view().row(0, 2)[4]);
}

TEST_F(OwnPng, RefusesWhatBreaksOff) {
  std::vector<std::uint8_t> bytes = *encodePng(picture(PixelFormat::kRgb8, {200, 200}).view());
  bytes.resize(bytes.size() / 2);
  write(bytes);
  const Result<Image> read = readOwnPng(file());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kInvalidInput);
}

TEST_F(OwnPng, RefusesADamagedByte) {
  std::vector<std::uint8_t> bytes = *encodePng(picture(PixelFormat::kRgb8, {200, 200}).view());
  bytes[bytes.size() / 2] ^= 0x55U;
  write(bytes);
  EXPECT_FALSE(readOwnPng(file()));
}

TEST_F(OwnPng, RefusesWhatIsNone) {
  write({'G', 'I', 'F', '8', '9', 'a', 0, 0, 0, 0});
  const Result<Image> read = readOwnPng(file());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kInvalidInput);
  EXPECT_EQ(readOwnPng(folder_.path() / "none.png").error().kind, ErrorKind::kNotFound);
}

TEST_F(OwnPng, RefusesASizeBeyondTheLimitsBeforeItTakesMemory) {
  // The signature, IHDR of 9000 x 1 px in grey, and the beginning of IDAT.
  write({0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48,
         0x44, 0x52, 0x00, 0x00, 0x23, 0x28, 0x00, 0x00, 0x00, 0x01, 0x08, 0x00, 0x00, 0x00,
         0x00, 0x96, 0x48, 0x5a, 0x99, 0x00, 0x00, 0x00, 0x28, 0x49, 0x44, 0x41, 0x54});
  const Result<Image> read = readOwnPng(file());
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().kind, ErrorKind::kUnsupported);
}

TEST_F(OwnPng, CannotHoldYCbCr) {
  const Image image({.pixelFormat = PixelFormat::kI420, .size = {8, 8}, .encoding = {}});
  const auto bytes = encodePng(image.view());
  ASSERT_FALSE(bytes);
  EXPECT_EQ(bytes.error().kind, ErrorKind::kUnsupported);
}

}  // namespace
}  // namespace pleinair::hal
