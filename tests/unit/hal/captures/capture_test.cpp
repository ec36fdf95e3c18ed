// What a camera did, recorded and played again.
#include <chrono>
#include <fstream>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/cameras/recording/recording.h"
#include "hal/captures/capture_writer.h"
#include "tests/support/temporary_folder.h"

namespace pleinair::hal::captures {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

class CaptureTest : public testing::Test {
 protected:
  static constexpr TimePoint kStart{1000s};

  std::filesystem::path path() const { return folder_.path() / "capture.mkv"; }

  /// A frame whose bytes depend on `number`.
  CapturedFrame frame(FrameFormat format, int number) {
    const auto image = std::make_shared<Image>(format);
    for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
      std::uint8_t value = static_cast<std::uint8_t>(17 * number + 5 * plane);
      for (std::uint8_t& byte : image->plane(plane))
        byte = value = static_cast<std::uint8_t>(value * 7 + 3);
    }
    // Not a multiple of a microsecond, nor even.
    return {.image = image->view(),
            .captureTime = kStart + number * 33'333'333ns + (number % 3) * 1'234'567ns,
            .lease = image};
  }

  void record(FrameFormat format, const std::vector<CapturedFrame>& frames) {
    auto writer = CaptureWriter::open(
        path(),
        {.camera = {.backend = "v4l2", .id = "usb-1", .description = "HD Webcam"},
         .format = {.frame = format, .framePeriod = 33'333'333ns},
         .request = "640x480 at 30; exposure 8.5"},
        kStart);
    ASSERT_TRUE(writer) << writer.error().message();
    for (const CapturedFrame& each : frames) ASSERT_TRUE((*writer)->write(each));
    ASSERT_TRUE((*writer)->finish());
  }

  std::vector<CapturedFrame> played(StreamFormat* format = nullptr) {
    std::vector<CapturedFrame> frames;
    camera_ = openRecording(path(), clock_);
    const auto started = camera_->start({});
    EXPECT_TRUE(started) << started.error().message();
    if (!started) return frames;
    if (format != nullptr) *format = *started;
    for (;;) {
      NextFrame next = camera_->next(kNoDeadline);
      auto* frame = std::get_if<CapturedFrame>(&next);
      if (frame == nullptr) {
        EXPECT_TRUE(std::holds_alternative<EndOfStream>(next));
        return frames;
      }
      frames.push_back(std::move(*frame));
    }
  }

  support::TemporaryFolder folder_;
  SteppedClock clock_;
  std::unique_ptr<Camera> camera_;
};

TEST_F(CaptureTest, PlaysPixelsToTheBitInTheCamerasLayout) {
  for (const PixelFormat pixels :
       {PixelFormat::kGrey8, PixelFormat::kRgb8, PixelFormat::kYuyv, PixelFormat::kNv12,
        PixelFormat::kI420, PixelFormat::kBayerGbrg8}) {
    const FrameFormat format{.pixelFormat = pixels,
                             .size = {62, 47},
                             .encoding = isYCbCr(pixels)
                                             ? ColorEncoding{ColorMatrix::kBt709, ColorRange::kFull}
                                             : ColorEncoding{}};
    std::vector<CapturedFrame> frames;
    for (int i = 0; i < 4; ++i) frames.push_back(frame(format, i));
    record(format, frames);
    StreamFormat streamed;
    const std::vector<CapturedFrame> again = played(&streamed);
    EXPECT_EQ(streamed.frame, format) << toString(pixels);
    EXPECT_EQ(streamed.framePeriod, Duration(33'333'333ns));
    ASSERT_EQ(again.size(), 4u) << toString(pixels);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(again[i].image.format, format);
      for (int plane = 0; plane < planeCount(pixels); ++plane) {
        for (int y = 0; y < planeRows(pixels, plane, format.size.height); ++y) {
          ASSERT_TRUE(std::ranges::equal(again[i].image.map().view().row(plane, y),
                                         frames[i].image.map().view().row(plane, y)))
              << toString(pixels) << ", frame " << i;
        }
      }
    }
  }
}

TEST_F(CaptureTest, PlaysTimesLossesAndHealthAsTheyWere) {
  const FrameFormat format{.pixelFormat = PixelFormat::kGrey8, .size = {16, 16}};
  std::vector<CapturedFrame> frames;
  for (int i = 0; i < 6; ++i) frames.push_back(frame(format, i));
  frames[2].droppedBefore = 3;
  frames[2].underrunsBefore = 1;
  frames[3].health = FrameHealth::kIncomplete;
  frames[3].linkBefore = {.missingPackets = 4, .resentPackets = 9};
  frames[4].deviceTime = 77s;
  frames[5].health = FrameHealth::kCorrupt;
  record(format, frames);
  const std::vector<CapturedFrame> again = played();
  ASSERT_EQ(again.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(again[i].captureTime - again[0].captureTime,
              frames[i].captureTime - frames[0].captureTime)
        << "to the nanosecond, frame " << i;
    EXPECT_EQ(again[i].droppedBefore, frames[i].droppedBefore);
    EXPECT_EQ(again[i].underrunsBefore, frames[i].underrunsBefore);
    EXPECT_EQ(again[i].health, frames[i].health);
    EXPECT_EQ(again[i].linkBefore, frames[i].linkBefore);
    EXPECT_EQ(again[i].deviceTime, frames[i].deviceTime);
  }
  EXPECT_EQ(again[5].sequence, 8u);
  EXPECT_THAT(camera_->identity().description, HasSubstr("of v4l2:usb-1 (HD Webcam)"));
}

TEST_F(CaptureTest, KeepsWhatThereIsOfATruncatedFile) {
  const FrameFormat format{.pixelFormat = PixelFormat::kGrey8, .size = {64, 64}};
  std::vector<CapturedFrame> frames;
  for (int i = 0; i < 20; ++i) frames.push_back(frame(format, i));
  record(format, frames);
  std::filesystem::resize_file(path(), std::filesystem::file_size(path()) / 2);
  camera_ = openRecording(path(), clock_);
  ASSERT_TRUE(camera_->start({}));
  std::size_t count = 0;
  for (;; ++count) {
    const NextFrame next = camera_->next(kNoDeadline);
    if (const auto* end = std::get_if<EndOfStream>(&next)) {
      EXPECT_TRUE(end->truncated);
      break;
    }
    ASSERT_TRUE(std::holds_alternative<CapturedFrame>(next));
  }
  EXPECT_GT(count, 3u);
  EXPECT_LT(count, 20u);
}

TEST_F(CaptureTest, LeavesNoFileBehindThatIsNotFinished) {
  {
    auto writer = CaptureWriter::open(
        path(), {.format = {.frame = {.pixelFormat = PixelFormat::kGrey8, .size = {8, 8}}}},
        kStart);
    ASSERT_TRUE(writer);
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
  EXPECT_FALSE(CaptureWriter::open(folder_.path() / "none" / "a.mkv", {}, kStart));
}

}  // namespace
}  // namespace pleinair::hal::captures
