// Photographs of phones carry ICC profiles, most of them Display P3.
#include "hal/media/icc_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>
#include <lcms2.h>

#include "hal/image.h"
#include "hal/media/frame_pixels.h"
#include "hal/media/picture_decoder.h"
#include "hal/media/picture_encoder.h"
#include "hal/media/srgb_profile.h"

namespace pleinair::hal::libav {
namespace {

using Colour = std::array<double, 3>;

constexpr FrameSize kPhotoSize{32, 16};
constexpr Colour kPhotoColour{200, 100, 80};

std::vector<std::uint8_t> savedProfile(cmsHPROFILE profile) {
  cmsUInt32Number size = 0;
  cmsSaveProfileToMem(profile, nullptr, &size);
  std::vector<std::uint8_t> bytes(size);
  cmsSaveProfileToMem(profile, bytes.data(), &size);
  cmsCloseProfile(profile);
  return bytes;
}

/// SMPTE EG 432-1's primaries with sRGB's curve.
std::vector<std::uint8_t> displayP3() {
  const cmsCIExyY white{0.3127, 0.3290, 1};
  const cmsCIExyYTRIPLE primaries{{0.680, 0.320, 1}, {0.265, 0.690, 1}, {0.150, 0.060, 1}};
  const std::array<cmsFloat64Number, 5> srgbCurve{2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92,
                                                  0.04045};
  cmsToneCurve* const curve = cmsBuildParametricToneCurve(nullptr, 4, srgbCurve.data());
  const std::array<cmsToneCurve*, 3> curves{curve, curve, curve};
  const cmsHPROFILE profile = cmsCreateRGBProfile(&white, &primaries, curves.data());
  cmsFreeToneCurve(curve);
  return savedProfile(profile);
}

std::vector<std::uint8_t> linearGrey() {
  cmsToneCurve* const curve = cmsBuildGamma(nullptr, 1.0);
  const cmsHPROFILE profile = cmsCreateGrayProfile(cmsD50_xyY(), curve);
  cmsFreeToneCurve(curve);
  return savedProfile(profile);
}

double lightOf(double level) {
  const double signal = level / 255;
  return signal <= 0.04045 ? signal / 12.92 : std::pow((signal + 0.055) / 1.055, 2.4);
}
double levelOf(double light) {
  const double inside = std::clamp(light, 0.0, 1.0);
  return 255 * (inside <= 0.0031308 ? 12.92 * inside : 1.055 * std::pow(inside, 1 / 2.4) - 0.055);
}

/// CSS Color 4 §17.2: linear light of Display P3 in sRGB's primaries.
Colour srgbOfP3(const Colour& p3) {
  const Colour light{lightOf(p3[0]), lightOf(p3[1]), lightOf(p3[2])};
  return {levelOf(1.2249401 * light[0] - 0.2249402 * light[1]),
          levelOf(-0.0420569 * light[0] + 1.0420571 * light[1]),
          levelOf(-0.0196376 * light[0] - 0.0786361 * light[1] + 1.0982736 * light[2])};
}

/// A frame of one colour, in the samples of its layout, with a profile.
template <class Sample>
Frame uniform(AVPixelFormat layout, const std::vector<Sample>& pixel,
              std::span<const std::uint8_t> profile) {
  Frame frame = makeFrame();
  frame->format = layout;
  frame->width = kPhotoSize.width;
  frame->height = kPhotoSize.height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  for (int y = 0; y < frame->height; ++y) {
    auto* row = reinterpret_cast<Sample*>(frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0]);
    for (int x = 0; x < frame->width; ++x) row = std::ranges::copy(pixel, row).out;
  }
  AVFrameSideData* const side =
      av_frame_new_side_data(frame.get(), AV_FRAME_DATA_ICC_PROFILE, profile.size());
  if (side == nullptr) throw std::bad_alloc();
  std::ranges::copy(profile, side->data);
  return frame;
}

/// The mean colour of what is lent.
Colour lentColour(const std::shared_ptr<const AVFrame>& frame,
                  Delivery delivery = Delivery::kAsStored) {
  const Result<LentPicture> picture = lendPicture(frame, delivery);
  if (!picture) {
    ADD_FAILURE() << picture.error().message();
    return {};
  }
  const std::size_t channels = delivery == Delivery::kRgba ? 4 : 3;
  Colour sum{};
  for (int y = 0; y < kPhotoSize.height; ++y) {
    const auto row = picture->view.row(0, y);
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (i % channels < 3) sum.at(i % channels) += row[i];
    }
  }
  for (double& each : sum) each /= static_cast<double>(kPhotoSize.pixels());
  return sum;
}

void expectNear(const Colour& colour, const Colour& expected, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(colour.at(c), expected.at(c), tolerance) << c;
}

std::vector<std::uint8_t> bytesOf(const Colour& colour) {
  return {static_cast<std::uint8_t>(colour[0]), static_cast<std::uint8_t>(colour[1]),
          static_cast<std::uint8_t>(colour[2])};
}

TEST(IccProfile, DisplayP3IsShownInItsColours) {
  for (const Colour& p3 : {kPhotoColour, Colour{90, 160, 70}, Colour{255, 0, 0}}) {
    expectNear(lentColour(uniform(AV_PIX_FMT_RGB24, bytesOf(p3), displayP3())), srgbOfP3(p3), 1.5);
  }
}

TEST(IccProfile, SixteenBitsKeepTheirMean) {
  const Colour p3{120.4, 100.3, 80.2};
  std::vector<std::uint16_t> pixel;
  for (const double each : p3) pixel.push_back(static_cast<std::uint16_t>(std::lround(257 * each)));
  expectNear(lentColour(uniform(AV_PIX_FMT_RGB48LE, pixel, displayP3())), srgbOfP3(p3), 0.25);
}

TEST(IccProfile, IsAppliedUnderAlpha) {
  std::vector<std::uint8_t> pixel = bytesOf(kPhotoColour);
  pixel.push_back(255);
  const std::vector<std::uint8_t> profile = displayP3();
  expectNear(lentColour(uniform(AV_PIX_FMT_RGBA, pixel, profile)), srgbOfP3(kPhotoColour), 1.5);
  pixel.back() = 0;
  expectNear(lentColour(uniform(AV_PIX_FMT_RGBA, pixel, profile)), {255, 255, 255}, 0);
}

TEST(IccProfile, GreyIsShownInItsTones) {
  const Frame frame = uniform(AV_PIX_FMT_GRAY8, std::vector<std::uint8_t>{128}, linearGrey());
  const double shown = levelOf(128.0 / 255);
  expectNear(lentColour(std::shared_ptr<const AVFrame>(
                 av_frame_clone(frame.get()), [](AVFrame* each) { av_frame_free(&each); })),
             {shown, shown, shown}, 1.0);
}

TEST(IccProfile, TexturesAreTakenAsTheyAre) {
  std::vector<std::uint8_t> pixel = bytesOf(kPhotoColour);
  expectNear(lentColour(uniform(AV_PIX_FMT_RGB24, pixel, displayP3()), Delivery::kRgba),
             kPhotoColour, 0);
}

TEST(IccProfile, OfSrgbAndUnusableOnesLeaveTheFrameAsItIs) {
  const std::vector<std::uint8_t> rubbish(200, 7);
  std::vector<std::uint8_t> cut = displayP3();
  cut.resize(cut.size() / 2);
  const std::vector<std::uint8_t> ofGrey = linearGrey();
  for (const std::vector<std::uint8_t>& profile : {srgbProfile(), rubbish, cut, ofGrey}) {
    const std::shared_ptr<const AVFrame> frame =
        uniform(AV_PIX_FMT_RGB24, bytesOf(kPhotoColour), profile);
    const Result<LentPicture> picture = lendPicture(frame);
    ASSERT_TRUE(picture) << picture.error().message();
    EXPECT_EQ(picture->view.planes[0].bytes.data(), frame->data[0]) << "lent without a copy";
  }
}

/// A JPEG with another profile than the encoder's, which is the only segment APP2.
std::vector<std::uint8_t> jpegWith(std::span<const std::uint8_t> profile) {
  Image photo({.pixelFormat = PixelFormat::kRgb8, .size = kPhotoSize, .encoding = {}});
  const std::vector<std::uint8_t> pixel = bytesOf(kPhotoColour);
  for (std::size_t i = 0; i < photo.plane(0).size(); ++i) photo.plane(0)[i] = pixel.at(i % 3);
  const std::vector<std::uint8_t> plain = orThrow(
      orThrow(openPictureEncoder(PictureFileKind::kJpeg, photo.format()))->encode(photo.view()));
  constexpr std::string_view kName("ICC_PROFILE\0\1\1", 14);
  std::vector<std::uint8_t> jpeg(plain.begin(), plain.begin() + 2);
  const std::size_t length = 2 + kName.size() + profile.size();
  for (const std::size_t byte :
       {std::size_t{0xFF}, std::size_t{0xE2}, length >> 8U, length & 255U}) {
    jpeg.push_back(static_cast<std::uint8_t>(byte));
  }
  jpeg.insert(jpeg.end(), kName.begin(), kName.end());
  jpeg.insert(jpeg.end(), profile.begin(), profile.end());
  for (std::size_t at = 2; at + 4 <= plain.size();) {
    const bool isScan = plain[at + 1] == 0xDA;
    const std::size_t bytes =
        isScan ? plain.size() - at : std::size_t{2} + (plain[at + 2] << 8U) + plain[at + 3];
    const auto from = plain.begin() + static_cast<std::ptrdiff_t>(at);
    if (plain[at + 1] != 0xE2) {
      jpeg.insert(jpeg.end(), from, from + static_cast<std::ptrdiff_t>(bytes));
    }
    at += bytes;
  }
  return jpeg;
}

TEST(IccProfile, OfAJpegFileIsRead) {
  const auto frame = decodePicture(jpegWith(displayP3()), "photo.jpg");
  ASSERT_TRUE(frame) << frame.error().message();
  expectNear(lentColour(*frame), srgbOfP3(kPhotoColour), 2.5);
}

}  // namespace
}  // namespace pleinair::hal::libav
