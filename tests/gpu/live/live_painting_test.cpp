// A live painting whose camera is lost.
#include "firmware_app/live/live_painting.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hal/error.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_pictures.h"

namespace pleinair::app {
namespace {

constexpr hal::FrameFormat kFormat{.pixelFormat = hal::PixelFormat::kRgb8, .size = {64, 48}};

/// Delivers so many frames, and is gone then.
class LostCamera final : public hal::Camera {
 public:
  LostCamera(int frames, hal::Clock& clock) : frames_(frames), clock_(clock) {}

  hal::CameraIdentity identity() const override { return {"lost", "lost", "lost"}; }
  hal::Result<hal::StreamFormat> start(const hal::StreamRequest&) override {
    next_ = 0;
    return hal::StreamFormat{.frame = kFormat, .framePeriod = std::chrono::milliseconds(40)};
  }
  hal::NextFrame next(hal::TimePoint) override {
    if (next_ == frames_) {
      return hal::CameraLost{{.kind = hal::ErrorKind::kDeviceLost,
                              .subject = "lost",
                              .problem = "has been unplugged"}};
    }
    const auto image = std::make_shared<const hal::Image>(support::testPicture(kFormat, next_));
    return hal::CapturedFrame{.image = image->view(),
                              .sequence = static_cast<std::uint64_t>(next_++),
                              .captureTime = clock_.now(),
                              .lease = image};
  }
  void stop() override {}

 private:
  int frames_;
  hal::Clock& clock_;
  int next_ = 0;
};

class LivePaintingTest : public testing::Test {
 protected:
  std::string paintFrom(int frames) {
    hal::SteadyClock clock;
    LostCamera camera(frames, clock);
    try {
      runLive({.camera = &camera,
               .clock = &clock,
               .options = {.output = output_, .style = "none"},
               .scene = {},
               .stills = folder_.path()});
    } catch (const hal::StartupError& error) {
      return error.error().message();
    }
    return "(nothing thrown)";
  }

  support::TemporaryFolder folder_;
  std::filesystem::path output_ = folder_.path() / "out.mp4";
};

TEST_F(LivePaintingTest, KeepsWhatWasPaintedWhenTheCameraIsLost) {
  EXPECT_THAT(paintFrom(1), testing::HasSubstr("lost: has been unplugged"));
  const auto played = support::play(output_);
  ASSERT_TRUE(played);
  EXPECT_EQ(played->frames.size(), 1u);
}

TEST_F(LivePaintingTest, LeavesNoFileOfACameraThatGaveNothing) {
  EXPECT_THAT(paintFrom(0), testing::HasSubstr("lost: has been unplugged"));
  EXPECT_EQ(folder_.entryCount(), 0u);
}

}  // namespace
}  // namespace pleinair::app
