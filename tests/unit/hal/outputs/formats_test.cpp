// The kinds of files that paintings are written to: codecs of movies, and pictures.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcms2.h>
#include <tiffio.h>

#include "hal/media/handles.h"
#include "hal/media/picture_file.h"
#include "hal/media/srgb_profile.h"
#include "hal/outputs/frames/frames_output.h"
#include "hal/outputs/movie/movie_output.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;

/// Odd, so that the codecs' even sizes show.
constexpr FrameSize kOddSize{65, 49};

/// The codec and the four characters that name it in the container.
std::pair<AVCodecID, std::uint32_t> codecIn(const std::filesystem::path& path) {
  AVFormatContext* raw = nullptr;
  if (avformat_open_input(&raw, path.c_str(), nullptr, nullptr) < 0) return {AV_CODEC_ID_NONE, 0};
  const libav::InputContext context(raw);
  const AVCodecParameters& coding = *context->streams[0]->codecpar;
  return {coding.codec_id, coding.codec_tag};
}

struct CodecCase {
  const char* name;
  VideoCodec codec;
  AVCodecID id;
};

class MovieCodecs : public testing::TestWithParam<CodecCase> {
 protected:
  void write(const char* name, std::optional<double> crf = std::nullopt) const {
    const auto movie =
        openMovieOutput(folder_.path() / name, {.codec = GetParam().codec, .crf = crf});
    const auto format = orThrow(movie->start({.size = kOddSize, .framePeriod = 40ms}));
    for (int i = 0; i < 12; ++i) {
      orThrow(movie->write(support::testPicture(format.frame, i).view(), i * 40ms));
    }
    orThrow(movie->finish());
  }
  support::TemporaryFolder folder_;
};

TEST_P(MovieCodecs, ArePlayedBack) {
  std::vector<const char*> names{"a.mkv"};
  if (GetParam().codec != VideoCodec::kFfv1) names.push_back("a.mp4");
  for (const char* name : names) {
    write(name);
    const auto [id, tag] = codecIn(folder_.path() / name);
    EXPECT_EQ(id, GetParam().id) << name;
    if (GetParam().codec == VideoCodec::kHevc && std::string(name) == "a.mp4") {
      EXPECT_EQ(tag, MKTAG('h', 'v', 'c', '1')) << "or some players show nothing";
    }
    const auto played = support::play(folder_.path() / name);
    ASSERT_TRUE(played) << played.error().message();
    ASSERT_EQ(played->frames.size(), 12U) << name;
    EXPECT_EQ(played->format.frame.size, (FrameSize{66, 50}));
    EXPECT_EQ(played->times[0], 0ms);
    EXPECT_EQ(played->times[11], 440ms);
    // Luma in the middle of the last frame, as it was written.
    const FrameFormat format{.pixelFormat = PixelFormat::kI420, .size = kOddSize};
    Image written = support::testPicture(format, 11);
    double apart = 0;
    for (int x = 0; x < kOddSize.width; ++x) {
      const auto at = static_cast<std::size_t>(x);
      apart +=
          std::abs(written.row(0, 24)[at] - played->frames[11].image.map().view().row(0, 24)[at]);
    }
    EXPECT_LT(apart / kOddSize.width, GetParam().codec == VideoCodec::kFfv1 ? 0.001 : 12.0) << name;
  }
}

TEST_P(MovieCodecs, GiveTheSameBytesAgain) {
  write("a.mkv");
  write("b.mkv");
  const auto bytes = [&](const char* name) {
    std::ifstream file(folder_.path() / name, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_TRUE(bytes("a.mkv") == bytes("b.mkv"));
  if (GetParam().codec == VideoCodec::kFfv1) return;
  write("coarse.mkv", 50);
  EXPECT_LT(bytes("coarse.mkv").size(), bytes("a.mkv").size());
}

INSTANTIATE_TEST_SUITE_P(All, MovieCodecs,
                         testing::Values(CodecCase{"h264", VideoCodec::kH264, AV_CODEC_ID_H264},
                                         CodecCase{"hevc", VideoCodec::kHevc, AV_CODEC_ID_HEVC},
                                         CodecCase{"av1", VideoCodec::kAv1, AV_CODEC_ID_AV1},
                                         CodecCase{"ffv1", VideoCodec::kFfv1, AV_CODEC_ID_FFV1}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(MovieCodec, ThatTheContainerCannotHoldIsRefused) {
  const support::TemporaryFolder folder;
  const auto movie = openMovieOutput(folder.path() / "a.mp4", {.codec = VideoCodec::kFfv1});
  const auto started = movie->start({.size = kOddSize});
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message(),
              testing::HasSubstr("cannot hold FFV1; end its name in .mkv"));
  EXPECT_EQ(folder.entryCount(), 0u);
}

class WrittenPictures : public testing::TestWithParam<const char*> {
 protected:
  /// The bytes of a picture that is written with these options.
  std::vector<std::uint8_t> written(const PictureFileOptions& options) {
    const auto output = openFramesOutput(path(), options);
    const auto format = orThrow(output->start({.size = kOddSize}));
    picture_ = support::testPicture(format.frame, 4);
    orThrow(output->write(picture_.view(), 0ms));
    orThrow(output->finish());
    std::ifstream file(path(), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::filesystem::path path() const { return folder_.path() / (std::string("a") + GetParam()); }
  bool isJpegName() const { return std::string(GetParam()).find('j') != std::string::npos; }

  support::TemporaryFolder folder_;
  Image picture_;
};

bool holds(const std::vector<std::uint8_t>& bytes, const std::string& part) {
  return std::search(bytes.begin(), bytes.end(), part.begin(), part.end()) != bytes.end();
}

TEST_P(WrittenPictures, AreReadBack) {
  written({});
  Image read = orThrow(readPictureRgb(path()));
  ASSERT_EQ(read.size(), kOddSize);
  double apart = 0;
  for (std::size_t i = 0; i < read.plane(0).size(); ++i) {
    apart += std::abs(read.plane(0)[i] - picture_.plane(0)[i]);
  }
  EXPECT_LE(apart / static_cast<double>(read.plane(0).size()), isJpegName() ? 4.0 : 0.0);
}

TEST_P(WrittenPictures, AreTaggedAsSrgbAndTheSameEachTime) {
  const auto first = written({});
  const bool isPng = path().extension() == ".png";
  EXPECT_TRUE(isPng ? holds(first, "sRGB") : holds(first, "acsp")) << "an ICC profile";
  EXPECT_TRUE(first == written({}));
}

INSTANTIATE_TEST_SUITE_P(All, WrittenPictures, testing::Values(".png", ".jpg", ".tif"),
                         [](const auto& each) { return std::string(each.param).substr(1); });

class Jpeg : public WrittenPictures {};
TEST_P(Jpeg, HasItsQualityAndResolution) {
  const auto plain = written({});
  const auto fine = written({.quality = 100, .dotsPerInch = 300});
  const auto coarse = written({.quality = 20});
  EXPECT_GT(fine.size(), plain.size());
  EXPECT_LT(coarse.size(), plain.size());
  // JFIF 1.02: units at byte 13, then the densities.
  EXPECT_THAT(std::vector(fine.begin() + 13, fine.begin() + 18),
              testing::ElementsAre(1, 1, 44, 1, 44));
  EXPECT_EQ(plain[13], 0);
}
INSTANTIATE_TEST_SUITE_P(Endings, Jpeg, testing::Values(".jpg", ".JPEG"));

class Tiff : public WrittenPictures {};
TEST_P(Tiff, HasItsResolution) {
  written({.dotsPerInch = 254});
  const std::unique_ptr<TIFF, decltype(&TIFFClose)> tiff(TIFFOpen(path().c_str(), "r"), &TIFFClose);
  ASSERT_NE(tiff, nullptr);
  float across = 0;
  std::uint16_t unit = 0;
  TIFFGetField(tiff.get(), TIFFTAG_XRESOLUTION, &across);
  TIFFGetField(tiff.get(), TIFFTAG_RESOLUTIONUNIT, &unit);
  EXPECT_EQ(across, 254.0F);
  EXPECT_EQ(unit, RESUNIT_INCH);
}
INSTANTIATE_TEST_SUITE_P(Endings, Tiff, testing::Values(".tif", ".TIFF"));

class Png : public WrittenPictures {};
TEST_P(Png, HasItsResolution) {
  EXPECT_TRUE(
      holds(written({.dotsPerInch = 254}), std::string("pHYs\0\0\x27\x10\0\0\x27\x10\1", 13)))
      << "10,000 pixels a metre";
  EXPECT_FALSE(holds(written({}), "pHYs"));
  EXPECT_TRUE(readPictureRgb(path()));
}
INSTANTIATE_TEST_SUITE_P(Endings, Png, testing::Values(".png"));

TEST(SrgbProfile, IsReadBackAsSrgb) {
  const std::vector<std::uint8_t>& bytes = srgbProfile();
  void* const profile =
      cmsOpenProfileFromMem(bytes.data(), static_cast<cmsUInt32Number>(bytes.size()));
  ASSERT_NE(profile, nullptr);
  EXPECT_EQ(cmsGetColorSpace(profile), cmsSigRgbData);
  std::array<char, 64> name{};
  cmsGetProfileInfoASCII(profile, cmsInfoDescription, "en", "US", name.data(), name.size());
  EXPECT_THAT(name.data(), testing::HasSubstr("sRGB"));
  cmsCloseProfile(profile);
}

}  // namespace
}  // namespace pleinair::hal
