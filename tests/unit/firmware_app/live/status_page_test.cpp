// The page for people of the status server.
#include "firmware_app/live/status/status_page.h"

#include <array>
#include <cstdint>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/live/status/thumbnail.h"
#include "hal/media/frame_pixels.h"
#include "hal/media/picture_decoder.h"

namespace pleinair::app {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(StatusPage, SaysWhatIsShownAndWhatIsNot) {
  runtime::RuntimeStatus status;
  status.camera.reason = "waiting for a camera";
  const std::string waiting = statusPage(status, "watercolor", {"full"});
  EXPECT_THAT(waiting, testing::StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(waiting, HasSubstr("no pictures are shown"));
  EXPECT_THAT(waiting, HasSubstr("There is no painting yet."));
  EXPECT_THAT(waiting, HasSubstr("waiting for a camera"));
  status.camera.state = hal::CameraState::kStreaming;
  status.painting.hasPainter = true;
  status.painting.painted = 12;
  status.painting.perSecond = 24.9;
  status.outputs.push_back(
      {.name = "window", .format = {.size = {640, 480}}, .perSecond = 24.9, .presented = 11});
  ASSERT_TRUE(status.isHealthy());
  const std::string well = statusPage(status, "watercolor", {"full"});
  EXPECT_THAT(well, HasSubstr("all is well"));
  EXPECT_THAT(well, HasSubstr("<img src=\"/painting.jpg\""));
  EXPECT_THAT(well, HasSubstr("24.9 frames a second, quality full"));
  EXPECT_THAT(well, HasSubstr("<th>Output window</th><td>640 × 480"));
  for (const char* link : {"\"/status\"", "\"/metrics\"", "\"/healthz\""}) {
    EXPECT_THAT(well, HasSubstr(link));
  }
}

TEST(StatusPage, SaysHowTheMachineIs) {
  runtime::RuntimeStatus status;
  EXPECT_THAT(statusPage(status, "none", {"full"}), Not(HasSubstr("<th>Machine</th>")));
  status.machine = hal::MachineState{
      .hottest = hal::ThermalZone{.name = "cpu-thermal", .celsius = 76.4, .limitCelsius = 80},
      .usedBytes = 312'400'000,
      .availableBytes = 1'230'000'000,
      .diskFreeBytes = 14'260'000'000,
      .clock = hal::ClockTrust::kWrong,
      .clockJumps = 2};
  status.painting.hasPainter = true;
  status.painting.quality = 1;
  status.painting.bestQuality = 1;
  const std::string page = statusPage(status, "none", {"full", "medium"});
  EXPECT_THAT(page, HasSubstr("cpu-thermal at 76 °C (slows down from 80 °C on); 312 MB of memory "
                              "used; 1.2 GB available; 14.3 GB of disk free"));
  EXPECT_THAT(page, HasSubstr("wrong: no schedule is followed; jumped 2 times"));
  EXPECT_THAT(page, HasSubstr("at most medium until the machine has cooled"));
}

TEST(StatusPage, ShowsNoMarkupOfNames) {
  runtime::RuntimeStatus status;
  status.camera.lastLoss = "<script>alert(\"x\")</script> & more";
  const std::string page = statusPage(status, "none", {});
  EXPECT_THAT(page, Not(HasSubstr("<script>")));
  EXPECT_THAT(page, HasSubstr("&lt;script&gt;alert(&quot;x&quot;)&lt;/script&gt; &amp; more"));
}

class Thumbnail : public testing::TestWithParam<std::tuple<hal::PixelFormat, hal::ColorRange>> {};

TEST_P(Thumbnail, HasTheFramesColours) {
  const auto [layout, range] = GetParam();
  const hal::FrameFormat format{.pixelFormat = layout,
                                .size = {1920, 1080},
                                .encoding = {.matrix = hal::ColorMatrix::kBt709, .range = range}};
  hal::Image frame(format);
  const bool isFull = range == hal::ColorRange::kFull;
  // BT.709 of (200, 100, 50): Y' 117.7, Pb -0.1430, Pr 0.2050, scaled by range.
  const int y = isFull ? 118 : 117;
  const int u = isFull ? 92 : 96;
  const int v = isFull ? 180 : 174;
  for (int plane = 0; plane < hal::planeCount(layout); ++plane) {
    for (int line = 0; line < hal::planeRows(layout, plane, format.size.height); ++line) {
      const auto row = frame.row(plane, line);
      for (std::size_t i = 0; i < row.size(); ++i) {
        int value = plane == 0 ? y : plane == 1 ? u : v;
        if (layout == hal::PixelFormat::kNv12 && plane == 1) value = i % 2 == 0 ? u : v;
        if (layout == hal::PixelFormat::kYuyv) value = i % 2 == 0 ? y : i % 4 == 1 ? u : v;
        if (layout == hal::PixelFormat::kRgb8) value = std::array{200, 100, 50}[i % 3];
        if (layout == hal::PixelFormat::kRgba8) value = std::array{200, 100, 50, 255}[i % 4];
        row[i] = static_cast<std::uint8_t>(value);
      }
    }
  }
  const auto jpeg = thumbnailJpeg(frame, 0);
  ASSERT_TRUE(jpeg) << jpeg.error().message();
  EXPECT_LT(jpeg->size(), 8000U);
  const auto decoded = hal::libav::decodePicture(
      std::span(reinterpret_cast<const std::uint8_t*>(jpeg->data()), jpeg->size()), "thumbnail");
  ASSERT_TRUE(decoded);
  const auto picture = hal::libav::lendPicture(*decoded, hal::libav::Delivery::kRgb);
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->view.format.size, (hal::FrameSize{480, 270}));
  const auto row = picture->view.row(0, 130);
  EXPECT_NEAR(row[3 * 200], 200, 5);
  EXPECT_NEAR(row[3 * 200 + 1], 100, 5);
  EXPECT_NEAR(row[3 * 200 + 2], 50, 5);
}

INSTANTIATE_TEST_SUITE_P(
    Layouts, Thumbnail,
    testing::Combine(testing::Values(hal::PixelFormat::kRgb8, hal::PixelFormat::kRgba8,
                                     hal::PixelFormat::kI420, hal::PixelFormat::kNv12,
                                     hal::PixelFormat::kYuyv),
                     testing::Values(hal::ColorRange::kLimited, hal::ColorRange::kFull)));

TEST(ThumbnailOfATurnedFrame, IsUpright) {
  // A frame that was turned clockwise by a right angle: its upright left is now its top.
  hal::Image frame({.pixelFormat = hal::PixelFormat::kGrey8, .size = {64, 128}});
  for (int y = 0; y < 128; ++y) {
    for (std::uint8_t& pixel : frame.row(0, y)) pixel = y < 64 ? 220 : 30;
  }
  const auto jpeg = thumbnailJpeg(frame, 1);
  ASSERT_TRUE(jpeg);
  const auto decoded = hal::libav::decodePicture(
      std::span(reinterpret_cast<const std::uint8_t*>(jpeg->data()), jpeg->size()), "thumbnail");
  ASSERT_TRUE(decoded);
  const auto picture = hal::libav::lendPicture(*decoded, hal::libav::Delivery::kRgb);
  ASSERT_TRUE(picture);
  ASSERT_EQ(picture->view.format.size, (hal::FrameSize{128, 64}));
  EXPECT_GT(picture->view.row(0, 32)[3 * 10], 200);
  EXPECT_LT(picture->view.row(0, 32)[3 * 118], 50);
}

}  // namespace
}  // namespace pleinair::app
