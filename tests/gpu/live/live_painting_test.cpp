// A live painting whose camera is lost.
#include "firmware_app/live/live_painting.h"

#include <chrono>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "firmware_app/cli/interrupt.h"
#include "firmware_app/live/live_painter.h"
#include "hal/error.h"
#include "hal/outputs/display/display_output.h"
#include "hal/outputs/registry.h"
#include "pipeline/styles/registry.h"
#include "pipeline/styles/strokes/brushes.h"
#include "tests/support/fake_card.h"
#include "tests/support/live_simulation.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test_pictures.h"

namespace pleinair::app {
namespace {

constexpr hal::FrameFormat kFormat{.pixelFormat = hal::PixelFormat::kRgb8, .size = {64, 48}};

/// A camera that is lost after so many frames; a negative number: it is absent.
class LostCamera final : public hal::Camera {
 public:
  LostCamera(int frames, hal::Clock& clock) : frames_(frames), clock_(clock) {}

  hal::CameraIdentity identity() const override { return {"lost", "lost", "lost"}; }
  hal::Result<hal::StreamFormat> start(const hal::StreamRequest&) override {
    if (frames_ < 0) {
      return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kNotFound,
                                       .subject = "lost",
                                       .problem = "is not there",
                                       .remedy = {}});
    }
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
  /// The error of runLive() with a camera that is lost after so many frames of each opening.
  std::string paintFrom(int framesAnOpening, std::uint64_t frames) {
    hal::SteadyClock clock;
    hal::CameraSelector selector = support::selectorOf(
        [framesAnOpening](hal::Clock& cameraClock) {
          return std::make_unique<LostCamera>(framesAnOpening, cameraClock);
        },
        clock, true);
    try {
      runLive({.selector = &selector,
               .request = {},
               .clock = &clock,
               .options = {.output = {}, .style = "none", .frames = frames},
               .outputs = {output_.string()},
               .openOutput = [](const std::string& target) { return hal::openOutput(target); },
               .runtime = {},
               .serveStatus =
                   [this](StatusPages pages) {
                     const std::scoped_lock lock(mutex_);
                     pages_ = std::move(pages);
                     return std::make_unique<Served>(*this);
                   },
               .waitsForCamera = waits_,
               .scene = {},
               .snapshots = folder_.path()});
    } catch (const hal::Failure& error) {
      return error.error().message();
    }
    return "";
  }

  /// Drops the pages when the painting ends, like the server.
  class Served final : public StatusServer {
   public:
    explicit Served(LivePaintingTest& test) : test_(test) {}
    ~Served() override {
      const std::scoped_lock lock(test_.mutex_);
      test_.pages_ = {};
    }
    const std::string& address() const override { return address_; }

   private:
    LivePaintingTest& test_;
    std::string address_ = "nowhere";
  };

  std::mutex mutex_;
  StatusPages pages_;
  bool waits_ = false;
  support::TemporaryFolder folder_;
  std::filesystem::path output_ = folder_.path() / "out.mp4";
};

TEST_F(LivePaintingTest, GoesOnWhenTheCameraComesBack) {
  EXPECT_EQ(paintFrom(2, 3), "");
  const auto played = support::play(output_);
  ASSERT_TRUE(played);
  EXPECT_EQ(played->frames.size(), 3u) << "more than one opening has to give";
}

TEST_F(LivePaintingTest, SaysAtTheStartThatThereIsNoCamera) {
  EXPECT_THAT(paintFrom(-1, 3), testing::HasSubstr("is not there"));
  EXPECT_EQ(folder_.entryCount(), 0u) << "and leaves no file";
}

TEST_F(LivePaintingTest, ShowsAPictureOnADisplayBeforeTheCameraIsMade) {
  hal::SteadyClock clock;
  support::FakeCards cards(clock);
  cards.add();
  std::optional<std::size_t> shownBeforeCamera;
  hal::CameraSelector selector = support::selectorOf(
      [&](hal::Clock& cameraClock) {
        if (!shownBeforeCamera) shownBeforeCamera = cards.shown.size();
        return std::make_unique<LostCamera>(1000, cameraClock);
      },
      clock, true);
  const hal::TimePoint began = clock.now();
  runLive(
      {.selector = &selector,
       .request = {.size = kFormat.size, .pixelFormat = {}, .framePeriod = {}, .controls = {}},
       .clock = &clock,
       .options = {.output = {}, .style = "none", .frames = 3},
       .outputs = {"display"},
       .openOutput = [&](const std::string& target) -> hal::Result<std::unique_ptr<hal::Output>> {
         return hal::openDisplay(target, {}, cards, clock);
       },
       .runtime = {},
       .state = folder_.path() / "state",
       .scene = {},
       .snapshots = folder_.path()});
  EXPECT_EQ(shownBeforeCamera, 1u);
  ASSERT_GE(cards.shown.size(), 2u);
  EXPECT_GT(cards.shown.front().firstPixel & 0xFFU, 200U) << "paper";
  EXPECT_EQ(cards.restores, 1);
  const hal::Duration took = cards.shown.front().time - began;
  EXPECT_LT(took, std::chrono::seconds(3));
  RecordProperty("first_picture_ms", std::to_string(hal::toMilliseconds(took)));
}

TEST(LivePainter, MakesNoBrushInAFrameWhateverTheLook) {
  const styles::StyleKind& kind = styles::styleKind("painterly");
  const auto parametersOf = [&kind](std::string_view look) {
    return LiveParameters{.style = "painterly",
                          .painting = {.style = kind.parametersOf(look), .view = {}}};
  };
  LiveControls controls(parametersOf("sketch"));
  LivePainter painter({.pictureSize = kFormat.size,
                       .style = "painterly",
                       .tracksTags = false,
                       .expectedFormat = kFormat},
                      controls, controls.parameters());
  painter.open(0, {.frame = kFormat});
  const std::uint64_t before = styles::brushesMade();
  EXPECT_GT(before, 0U);
  const hal::Image image = support::testPicture(kFormat, 1);
  for (const styles::Look& look : kind.looks) {
    controls.setParameters(parametersOf(look.name));
    EXPECT_TRUE(painter.paint({.image = image.view()}, 0));
    EXPECT_EQ(styles::brushesMade(), before) << look.name;
  }
}

TEST_F(LivePaintingTest, TellsItsStatusWhileItWaitsForACamera) {
  std::thread asks([&] {
    std::string json;
    for (int i = 0; i < 500 && json.find("is not there") == std::string::npos; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      const std::scoped_lock lock(mutex_);
      if (pages_.json) json = pages_.json();
    }
    EXPECT_THAT(json, testing::ContainsRegex("\"waiting for a camera: .*lost: is not there"));
    const std::scoped_lock lock(mutex_);
    if (pages_.json) {
      EXPECT_FALSE(pages_.healthy());
      EXPECT_THAT(pages_.metrics(), testing::HasSubstr("pleinair_"));
    }
    std::raise(SIGTERM);
  });
  const Interrupt interrupt;
  waits_ = true;
  EXPECT_EQ(paintFrom(-1, 3), "");
  asks.join();
}

TEST_F(LivePaintingTest, ChecksTheFoldersOfItsOutputsBeforeItWaitsForACamera) {
  waits_ = true;
  output_ = folder_.path() / "none" / "out.mp4";
  EXPECT_THAT(paintFrom(-1, 3),
              testing::AllOf(testing::HasSubstr("none is not there"), testing::HasSubstr("mkdir")));
}

}  // namespace
}  // namespace pleinair::app
