// A painter that draws straight into the surfaces of a display, from the camera's frames to the
// card, under a stepped clock: the trial that decides on it, and what goes wrong.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <gtest/gtest.h>

#include "hal/outputs/display/display_output.h"
#include "pipeline/runtime/live_pipeline.h"
#include "tests/support/fake_card.h"
#include "tests/support/live_simulation.h"
#include "tests/support/process_resources.h"

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;
using support::FakeCardSpec;
using support::SimulatedGpu;

FakeCardSpec gpuCard() {
  return {.gpuModifiers = {hal::kLinearModifier}, .planeModifiers = {hal::kLinearModifier}};
}

class DirectPainting : public testing::Test {
 protected:
  DirectPainting()
      : selector_(support::selectorOf(
            [this](hal::Clock& clock) {
              return std::make_unique<support::PacedCamera>(camera_, clock);
            },
            live_.clock)) {
    live_.gpu.drawable = {hal::kLinearModifier};
  }
  ~DirectPainting() override { live_.chain.reset(); }  // its displays, before their cards

  void begin(FakeCardSpec spec = gpuCard(), bool drawsDirectly = true) {
    card_ = &cards_.add(std::move(spec));
    live_.begin(selector_);
    OutputStageOptions options{.name = "display", .waiting = 16};
    options.drawsDirectly = drawsDirectly;
    options.keepsLastFrame = true;
    options.reopen = [this] { return hal::openDisplay("display", {}, cards_, live_.clock); };
    options.request = {.size = {64, 48}, .framePeriod = camera_.period};
    auto display = *hal::openDisplay("display", {}, cards_, live_.clock);
    const auto format = *display->start(options.request);
    stage_ = &live_.chain->addOutput(std::move(display), format, std::move(options));
    live_.start();
  }
  ScanOut scanOut() const { return stage_->status().scanOut; }
  std::uint64_t of(Outcome outcome) const {
    return stage_->status().ended.at(static_cast<std::size_t>(outcome));
  }
  /// Of the pictures that were shown from a number on, how many the GPU drew in place.
  long directSince(std::size_t from) const {
    return std::count_if(cards_.shown.begin() + static_cast<long>(from), cards_.shown.end(),
                         [](const auto& each) { return each.firstPixel >= SimulatedGpu::kDrawn; });
  }
  void expectOnlyCopies(const std::string& reason) {
    const std::size_t before = cards_.shown.size();
    live_.runFor(1s);
    EXPECT_GT(cards_.shown.size(), before + 20);
    EXPECT_EQ(directSince(before), 0);
    EXPECT_EQ(scanOut().path, ScanOut::Path::kCopied);
    EXPECT_NE(scanOut().reason.find(reason), std::string::npos) << scanOut().reason;
    EXPECT_EQ(stage_->status().failures, 0u);
  }
  void expectSumsToAgree() {
    EXPECT_TRUE(live_.chain->ledger().counts().addsUp());
    for (const auto& output : live_.chain->status().outputs) EXPECT_TRUE(output.addsUp());
  }

  support::LiveSimulation live_;
  support::PacedCameraOptions camera_;
  support::FakeCards cards_{live_.clock};
  FakeCardSpec* card_ = nullptr;
  hal::CameraSelector selector_;
  OutputStage* stage_ = nullptr;
};

TEST_F(DirectPainting, ShowsEveryFrameAtItsRefreshWithoutACopy) {
  begin();
  live_.runFor(500ms);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
  EXPECT_EQ(live_.gpu.imports, 1);
  const std::size_t before = cards_.shown.size();
  const std::uint64_t shown = of(Outcome::kShown);
  live_.runFor(10s);
  EXPECT_GE(of(Outcome::kShown), shown + 299);
  EXPECT_EQ(directSince(before), static_cast<long>(cards_.shown.size() - before));
  for (std::size_t i = before + 1; i < cards_.shown.size(); ++i) {
    ASSERT_EQ(cards_.shown[i].firstPixel, cards_.shown[i - 1].firstPixel + 1) << "out of order";
  }
  EXPECT_LE(scanOut().direct - static_cast<std::uint64_t>(directSince(0)), 1u)
      << "one is on its way";
  expectSumsToAgree();
}

TEST_F(DirectPainting, CopiesWhereItIsNotToDrawDirectly) {
  begin(gpuCard(), false);
  live_.runFor(1s);
  EXPECT_EQ(directSince(0), 0);
  EXPECT_EQ(live_.gpu.imports, 0);
}

TEST_F(DirectPainting, CopiesWhereThePainterDrawsNowhereElse) {
  live_.gpu.drawable.clear();
  begin();
  expectOnlyCopies("draws nowhere else");
}

TEST_F(DirectPainting, CopiesWhereTheCardHasNoBuffersForAGpu) {
  begin(FakeCardSpec{});
  expectOnlyCopies("cannot make a buffer");
}

TEST_F(DirectPainting, CopiesWhereTheCardRefusesThem) {
  FakeCardSpec spec = gpuCard();
  spec.refusesGpuTests = true;
  begin(spec);
  expectOnlyCopies("refuses to show");
}

TEST_F(DirectPainting, CopiesWhereTheImportIsRefused) {
  live_.gpu.importError = hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                     .subject = "GPU",
                                     .problem = "makes no image of it",
                                     .remedy = {}};
  begin();
  expectOnlyCopies("makes no image of it");
}

TEST_F(DirectPainting, CopiesWhereThePatternArrivesWrong) {
  live_.gpu.drawsWrong = true;
  begin();
  expectOnlyCopies("arrives wrong");
}

TEST_F(DirectPainting, CopiesWhereTheCardSeesOtherPixels) {
  FakeCardSpec spec = gpuCard();
  spec.garblesGpuBuffers = true;
  begin(spec);
  expectOnlyCopies("arrives wrong");
}

TEST_F(DirectPainting, CopiesWhereTheSecondSurfaceHasNoMemory) {
  FakeCardSpec spec = gpuCard();
  spec.memoryBytes = std::size_t{(64 * 4 + 64) * 48} * 9 / 2;
  begin(spec);
  expectOnlyCopies("no memory for more");
}

TEST_F(DirectPainting, CopiesOnceTheCardRefusesAFlipAfterAll) {
  begin();
  live_.runFor(1s);
  ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect);
  card_->refusesGpuFlips = true;
  live_.runFor(500ms);
  expectOnlyCopies("has refused");
  expectSumsToAgree();
}

TEST_F(DirectPainting, GoesOnWithTheCardThatCameBackWhileSurfacesWereLent) {
  begin();
  live_.runFor(1s);
  card_->isGone = true;
  live_.runFor(2s);
  EXPECT_TRUE(stage_->status().isFailed);
  card_->isGone = false;
  live_.runFor(8s);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
  EXPECT_EQ(live_.gpu.imports, 2);
  const std::size_t before = cards_.shown.size();
  live_.runFor(1s);
  EXPECT_GE(directSince(before), 29);
  expectSumsToAgree();
}

TEST_F(DirectPainting, AHundredUnplugsOfMonitorAndCardLeaveNothingBehind) {
  begin();
  const auto unplug = [&](bool& state, bool unplugged) {
    state = unplugged;
    live_.runFor(1200ms);  // the connector is looked at once a second
    ASSERT_TRUE(stage_->status().isFailed);
    ASSERT_EQ(cards_.openCards, 0);
    ASSERT_EQ(cards_.buffers + cards_.gpuBuffers + cards_.blobs, 0)
        << "of the display that is gone";
    state = !unplugged;
    stage_->retry();  // as an event of the kernel's does
    live_.runFor(400ms);
    ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
    ASSERT_FALSE(stage_->status().isFailed);
  };
  live_.runFor(500ms);
  bool& isConnected = card_->connectors.front().isConnected;
  ASSERT_NO_FATAL_FAILURE(unplug(card_->isGone, true));  // so that all that lasts is there
  const support::ProcessResources before = support::ProcessResources::now();
  const int buffers = cards_.buffers;
  const int gpuBuffers = cards_.gpuBuffers;
  for (int i = 0; i < 100; ++i) {
    ASSERT_NO_FATAL_FAILURE(unplug(isConnected, false)) << "monitor " << i;
    ASSERT_NO_FATAL_FAILURE(unplug(card_->isGone, true)) << "card " << i;
  }
  const support::ProcessResources after = support::ProcessResources::now();
  EXPECT_EQ(after.descriptors, before.descriptors);
  EXPECT_EQ(after.threads, before.threads);
  EXPECT_EQ(cards_.buffers, buffers);
  EXPECT_EQ(cards_.gpuBuffers, gpuBuffers);
  EXPECT_EQ(cards_.openCards, 1);
  expectSumsToAgree();
}

TEST_F(DirectPainting, GoesOnWithTheGpuThatCameBack) {
  int losses = 2;
  live_.gpu.isLostAt = [&](std::uint64_t sequence) { return sequence % 50 == 49 && losses-- > 0; };
  begin();
  live_.runFor(8s);
  EXPECT_EQ(live_.gpu.made, 3);
  EXPECT_EQ(live_.gpu.imports, 3);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect) << scanOut().reason;
  const std::size_t before = cards_.shown.size();
  live_.runFor(1s);
  EXPECT_GE(directSince(before), 29);
  EXPECT_LE(cards_.gpuBuffers, 17) << "those of earlier loans are gone";
  expectSumsToAgree();
}

TEST_F(DirectPainting, FollowsAnotherStream) {
  begin();
  live_.runFor(1s);
  stage_->reconfigure({.size = {40, 48}, .framePeriod = camera_.period});
  live_.runFor(1s);
  EXPECT_EQ(scanOut().path, ScanOut::Path::kDirect);
  const std::size_t before = cards_.shown.size();
  live_.runFor(1s);
  EXPECT_GE(cards_.shown.size(), before + 29);
  expectSumsToAgree();
}

TEST_F(DirectPainting, FramesThatAppearOverAPictureAreCopied) {
  begin();
  live_.runFor(1s);
  const hal::FrameFormat format = stage_->format().frame;
  const std::size_t before = cards_.shown.size();
  // The camera pauses: the picture is shown as soon as no frame waits.
  live_.gpu.cost = [](std::uint64_t, std::size_t) { return hal::Duration(400ms); };
  stage_->showWaiting(std::make_shared<const hal::Image>(format));
  live_.runFor(2s);
  live_.gpu.cost = [](std::uint64_t, std::size_t) { return hal::Duration(10ms); };
  live_.runFor(3s);
  const std::size_t after = cards_.shown.size();
  EXPECT_GT(static_cast<long>(after - before), directSince(before)) << "some were blended";
  live_.runFor(1s);
  EXPECT_EQ(directSince(after), static_cast<long>(cards_.shown.size() - after));
  expectSumsToAgree();
}

TEST_F(DirectPainting, FramesUnderACaptionAreCopied) {
  begin();
  live_.runFor(500ms);
  ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect);
  auto caption = std::make_shared<Caption>();
  caption->image =
      hal::Image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {4, 2}, .encoding = {}});
  for (std::size_t i = 0; i < 32; ++i) caption->image.plane(0)[i] = i % 4 == 3 ? 255 : 0x20;
  caption->frame = stage_->format().frame;
  stage_->setCaption(caption, 1.0);
  live_.runFor(300ms);  // those that were drawn before have been shown
  std::size_t before = cards_.shown.size();
  live_.runFor(1s);
  EXPECT_EQ(directSince(before), 0);
  EXPECT_EQ(cards_.shown.back().firstPixel & 0xFFFFFFU, 0x202020U);
  stage_->setCaption(nullptr, 0.0);
  live_.runFor(300ms);
  before = cards_.shown.size();
  live_.runFor(1s);
  EXPECT_EQ(directSince(before), static_cast<long>(cards_.shown.size() - before));
  expectSumsToAgree();
}

TEST_F(DirectPainting, TheLastFrameIsReadOfTheDisplaysMemory) {
  begin();
  live_.runFor(1s);
  ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect);
  std::optional<hal::Image> last;
  std::thread asking([&] { last = stage_->lastFrame(); });
  // The output thread's part, until it is answered.
  std::uint32_t shown = 0;
  for (int i = 0; i < 2000 && !last; ++i) {
    stage_->step();
    shown = cards_.shown.back().firstPixel;
    std::this_thread::yield();
  }
  asking.join();
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->format(), stage_->format().frame);
  const auto pixel = last->row(0, 3).subspan(8, 4);
  EXPECT_EQ(pixel[0], (shown >> 16U) & 255U);
  EXPECT_EQ(pixel[1], (shown >> 8U) & 255U);
  EXPECT_EQ(pixel[2], shown & 255U);
}

TEST_F(DirectPainting, TheLastFrameIsThereAfterTheEnd) {
  begin();
  live_.runFor(1s);
  ASSERT_EQ(scanOut().path, ScanOut::Path::kDirect);
  const std::uint32_t shown = cards_.shown.back().firstPixel;  // the end may flip to another
  ASSERT_TRUE(stage_->finish().has_value());
  std::optional<hal::Image> last = stage_->lastFrame();
  ASSERT_TRUE(last.has_value());
  EXPECT_EQ(last->row(0, 3)[8], (shown >> 16U) & 255U);
  EXPECT_EQ(last->row(0, 3)[10], shown & 255U);
}

}  // namespace
}  // namespace pleinair::runtime
