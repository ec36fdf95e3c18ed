#include "hal/outputs/display/display_output.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hal/outputs/display/display_errors.h"
#include "tests/support/fake_card.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/hal/outputs/display/display_test.h"

namespace pleinair::hal {
namespace {

using display::Placement;
using support::FakeCards;
using support::FakeCardSpec;

using support::DisplayTest;
using support::kPainted;

TEST_F(DisplayTest, SetsTheModeOnceAndThenChangesThePictureOnly) {
  plug();
  ASSERT_TRUE(start().has_value());
  EXPECT_EQ(cards_.tests, 1);
  EXPECT_EQ(cards_.modesets, 1);
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.modesets, 1);
  ASSERT_EQ(cards_.changesOfFlips.size(), 10u);
  EXPECT_EQ(std::ranges::count(cards_.changesOfFlips, 1u), 10);
  EXPECT_EQ(cards_.shown.back().firstPixel, kPainted);
}

TEST_F(DisplayTest, ReportsTheRefreshesThatTheCardCounted) {
  plug();
  ASSERT_TRUE(start().has_value());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(showAndWait().has_value());
  ASSERT_EQ(events_.size(), 5u);
  for (std::size_t i = 0; i < events_.size(); ++i) {
    EXPECT_EQ(events_[i].sequence, cards_.shown[i].sequence);
    EXPECT_EQ(events_[i].time, cards_.shown[i].time);
  }
}

TEST_F(DisplayTest, KnowsTheRefreshesBeforeTheFirstFlip) {
  plug();
  clock_.sleepUntil(clock_.now() + std::chrono::milliseconds(5));
  const Result<OutputFormat> format = start();
  ASSERT_TRUE(format.has_value());
  const Refresh refresh = *format->refresh;
  ASSERT_TRUE(refresh.phase && refresh.sequence);
  EXPECT_EQ(refresh.phase->time_since_epoch(),
            static_cast<std::int64_t>(*refresh.sequence) * refresh.period);
  const TimePoint due = *refresh.phase + 7 * refresh.period;
  ASSERT_TRUE(show(due).has_value());
  ASSERT_TRUE(runTo(due + refresh.period).has_value());
  ASSERT_EQ(events_.size(), 1u);
  EXPECT_EQ(events_.front().sequence, sequenceAt(due, refresh));
  EXPECT_EQ(events_.front().sequence, *refresh.sequence + 7);
}

TEST_F(DisplayTest, FollowsTheRefreshesWhileNothingIsShown) {
  plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  ASSERT_TRUE(runTo(clock_.now() + std::chrono::seconds(60)).has_value());
  const Result<OutputFormat> format = output_->reconfigure({.size = {32, 48}, .framePeriod = {}});
  ASSERT_TRUE(format.has_value());
  EXPECT_LE(clock_.now() - *format->refresh->phase, std::chrono::seconds(1) + period_);
  EXPECT_GT(*format->refresh->sequence, *events_.front().sequence + 3500);
}

TEST_F(DisplayTest, ACardWithoutVerticalBlankingIsPacedByTheClock) {
  plug({.hasVblank = false});
  const Result<OutputFormat> format = start();
  ASSERT_TRUE(format.has_value());
  ASSERT_TRUE(format->refresh->phase.has_value());
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(showAndWait().has_value());
  ASSERT_EQ(events_.size(), 5u);
  for (const PresentationEvent& each : events_) {
    EXPECT_FALSE(each.sequence.has_value());
    EXPECT_EQ((each.time - *format->refresh->phase) % period_, Duration::zero());
  }
}

TEST_F(DisplayTest, TakesAnotherStreamInTheSameModeWithoutAModeset) {
  plug({.connectors = {{.modes = {{.size = {128, 48}}}}}});
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  const Result<OutputFormat> format = output_->reconfigure({.size = {32, 48}, .framePeriod = {}});
  ASSERT_TRUE(format.has_value()) << format.error().message();
  EXPECT_EQ(format->frame.size, (FrameSize{32, 48}));
  EXPECT_EQ(cards_.modesets, 1);
  EXPECT_EQ(cards_.restores, 0);
  // Whatever lay beside the smaller picture is black.
  const auto surface = output_->acquire();
  ASSERT_TRUE(surface->has_value());
  {
    const auto mapping = output_->map(**surface);
    EXPECT_TRUE(std::ranges::all_of(mapping->plane(0), [](std::uint8_t b) { return b == 0; }));
  }
  output_->release(**surface);
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.flips, 3);
}

TEST_F(DisplayTest, AnotherRateOfTheCameraMayTakeAnotherMode) {
  plug({.connectors = {{.modes = {{.size = {64, 48}, .hertz = 60.0, .isPreferred = true},
                                  {.size = {64, 48}, .hertz = 50.0}}}}});
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  const auto format =
      output_->reconfigure({.size = kSize, .framePeriod = std::chrono::milliseconds(40)});
  ASSERT_TRUE(format.has_value()) << format.error().message();
  EXPECT_EQ(cards_.modesets, 2);
  EXPECT_NEAR(toSeconds(format->refresh->period), 0.02, 1e-6);
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.shown.back().firstPixel, kPainted);
  EXPECT_EQ(cards_.buffers, 3);
  EXPECT_EQ(cards_.blobs, 1);
  output_.reset();
  EXPECT_EQ(cards_.restores, 1) << "what was shown before all of it";
}

TEST_F(DisplayTest, PicturesLieBetweenBlackBars) {
  plug({.connectors = {{.modes = {{.size = {128, 48}}}}}});
  const Result<OutputFormat> format = start();
  EXPECT_EQ(format->frame.size, kSize);
  const auto surface = output_->acquire();
  ASSERT_TRUE(surface->has_value());
  EXPECT_EQ((*surface)->planes[0].offsetBytes, 32u * 4);
  const auto mapping = output_->map(**surface);
  // The last row ends within the buffer.
  EXPECT_GE(mapping->plane(0).size(), (*surface)->planes[0].strideBytes * 47 + 64u * 4);
}

TEST_F(DisplayTest, ATurnedDisplayWantsUprightPicturesTurned) {
  plug({.connectors = {{.modes = {{.size = {480, 640}}}}}});
  const Result<OutputFormat> format = start("display", {.placement = {.quarterTurns = 1}});
  EXPECT_EQ(format->frame.size, (FrameSize{480, 640}));
  EXPECT_EQ(format->quarterTurns, 1);
}

TEST_F(DisplayTest, BringsBackWhatWasSavedCrtc) {
  plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  ASSERT_TRUE(output_->finish().has_value());
  EXPECT_EQ(cards_.restores, 1);
  output_.reset();
  EXPECT_EQ(cards_.restores, 1);
  EXPECT_EQ(cards_.buffers, 0);
  EXPECT_EQ(cards_.blobs, 0);
  EXPECT_EQ(cards_.openCards, 0);
}

TEST_F(DisplayTest, BringsItBackWithoutFinish) {
  plug();
  ASSERT_TRUE(start().has_value());
  output_.reset();
  EXPECT_EQ(cards_.restores, 1);
}

TEST_F(DisplayTest, AMonitorThatIsSwitchedOffDuringAFlipIsLostWithinASecond) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  ASSERT_TRUE(show(clock_.now() + period_).has_value());
  card.connectors.front().isConnected = false;
  const TimePoint off = clock_.now();
  Result<void> ran;
  while (ran.has_value() && clock_.now() < off + std::chrono::seconds(3)) ran = showAndWait();
  ASSERT_FALSE(ran.has_value());
  EXPECT_EQ(ran.error().kind, ErrorKind::kDeviceLost);
  EXPECT_LE(clock_.now() - off, std::chrono::milliseconds(1100));
  // It is there again with another mode.
  output_.reset();
  card.connectors.front().isConnected = true;
  card.connectors.front().modes = {{.size = {80, 60}, .hertz = 50.0}};
  const Result<OutputFormat> format = start();
  ASSERT_TRUE(format.has_value());
  EXPECT_EQ(format->frame.size, (FrameSize{80, 60}));
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(DisplayTest, NoMonitorAtStartIsADisplayThatMayCome) {
  plug({.connectors = {{.isConnected = false}}});
  const Result<OutputFormat> format = start();
  ASSERT_FALSE(format.has_value());
  EXPECT_EQ(format.error().kind, ErrorKind::kDeviceLost);
}

TEST_F(DisplayTest, TwoDisplaysOfACardAreIndependent) {
  FakeCardSpec& card = plug({.connectors = {{.name = "HDMI-A-1"}, {.name = "DP-1"}}});
  ASSERT_TRUE(start("display:HDMI-A-1").has_value());
  auto first = std::move(output_);
  ASSERT_TRUE(start("display:DP-1").has_value());
  EXPECT_EQ(cards_.openCards, 1);  // there is only one master
  ASSERT_TRUE(showAndWait().has_value());
  std::swap(first, output_);
  events_.clear();
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(events_.size(), 1u);
  std::swap(first, output_);
  // One leaves, the other goes on.
  card.connectors.back().isConnected = false;
  clock_.advance(std::chrono::seconds(2));
  EXPECT_FALSE(showAndWait().has_value());
  std::swap(first, output_);
  first.reset();
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(DisplayTest, ACardThatIsPulledOutIsLostAndCanComeBack) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  card.isGone = true;
  const Result<void> ran = showAndWait();
  ASSERT_FALSE(ran.has_value());
  EXPECT_EQ(ran.error().kind, ErrorKind::kDeviceLost);
  output_.reset();
  EXPECT_EQ(start().error().kind, ErrorKind::kNotFound);
  card.isGone = false;
  ASSERT_TRUE(start().has_value());
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(DisplayTest, AnotherMasterAtTheStartIsToldAndMayGo) {
  FakeCardSpec& card = plug({.hasOtherMaster = true});
  EXPECT_EQ(start().error().kind, ErrorKind::kBusy);
  card.hasOtherMaster = false;
  ASSERT_TRUE(start().has_value());
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(DisplayTest, ARefusedModeGivesWayToOneThatIsTakenIfTheChoiceIsOurs) {
  plug({.connectors = {{.modes = {{.size = {200, 100}, .isPreferred = true, .isRefused = true},
                                  {.size = {100, 50}, .isRefused = true},
                                  {.size = {64, 48}}}}}});
  const Result<OutputFormat> format = start();
  ASSERT_TRUE(format.has_value()) << format.error().message();
  EXPECT_EQ(format->frame.size, (FrameSize{64, 48}));
  EXPECT_EQ(cards_.modesets, 1);
  output_.reset();
  EXPECT_EQ(cards_.buffers, 0);
}

TEST_F(DisplayTest, ARefusedModeThatWasNamedIsAnError) {
  plug({.connectors = {{.modes = {{.size = {200, 100}, .isRefused = true}, {.size = {64, 48}}}}}});
  const Result<OutputFormat> format = start("display", {.mode = "200x100"});
  ASSERT_FALSE(format.has_value());
  EXPECT_EQ(format.error().kind, ErrorKind::kUnsupported);
  EXPECT_NE(format.error().message().find("200x100"), std::string::npos);
  EXPECT_EQ(cards_.modesets, 0);
}

TEST_F(DisplayTest, AFlipThatNeverComesIsLostWithinASecond) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  card.losesFlips = true;
  const TimePoint began = clock_.now();
  ASSERT_TRUE(show(began + period_).has_value());
  const Result<void> ran = runTo(began + std::chrono::seconds(3));
  ASSERT_FALSE(ran.has_value());
  EXPECT_EQ(ran.error().kind, ErrorKind::kDeviceLost);
  EXPECT_LE(clock_.now() - began, std::chrono::milliseconds(1100));
  card.losesFlips = false;
  output_.reset();
  ASSERT_TRUE(start().has_value());
  EXPECT_EQ(cards_.modesets, 2);
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(DisplayTest, ABusyCardDropsNothing) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  for (int i = 0; i < 20; ++i) {
    card.busyFlips = 5;
    ASSERT_TRUE(showAndWait().has_value());
  }
  EXPECT_EQ(events_.size(), 20u);
  EXPECT_EQ(
      std::ranges::count(events_, PresentationEvent::Result::kShown, &PresentationEvent::result),
      20);
}

TEST_F(DisplayTest, ACardThatStaysBusyIsLostWithinASecond) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  card.busyFlips = 1'000'000;
  const TimePoint began = clock_.now();
  ASSERT_TRUE(show(began + period_).has_value());
  const Result<void> ran = runTo(began + std::chrono::seconds(3));
  ASSERT_FALSE(ran.has_value());
  EXPECT_EQ(ran.error().kind, ErrorKind::kDeviceLost);
  EXPECT_LE(clock_.now() - began, std::chrono::milliseconds(1100));
  card.busyFlips = 0;
  output_.reset();
  ASSERT_TRUE(start().has_value());
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(DisplayTest, AFlipWithoutMemoryIsSkipped) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  card.memorylessFlips = 1;
  ASSERT_TRUE(showAndWait().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  ASSERT_EQ(events_.size(), 2u);
  EXPECT_EQ(events_[0].result, PresentationEvent::Result::kSkipped);
  EXPECT_EQ(events_[1].result, PresentationEvent::Result::kShown);
}

TEST_F(DisplayTest, NoMemoryForTheBuffersIsAnErrorThatLeavesNothingBehind) {
  plug({.memoryBytes = 64 * 48 * 4});
  const Result<OutputFormat> format = start();
  ASSERT_FALSE(format.has_value());
  output_.reset();
  EXPECT_EQ(cards_.buffers, 0);
  EXPECT_EQ(cards_.blobs, 0);
}

TEST_F(DisplayTest, ASuspendedMachineGoesOnWithTheNextPicture) {
  plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(show(clock_.now() + period_).has_value());
  ASSERT_TRUE(runTo(clock_.now() + 2 * period_).has_value());
  clock_.advance(std::chrono::hours(8));
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(events_.size(), 2u);
}

TEST_F(DisplayTest, AHundredUnplugsLeaveNothingBehind) {
  FakeCardSpec& card = plug();
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(start().has_value());
    ASSERT_TRUE(showAndWait().has_value());
    card.isGone = true;
    ASSERT_FALSE(showAndWait().has_value());
    output_.reset();
    card.isGone = false;
    ASSERT_EQ(cards_.buffers, 0);
    ASSERT_EQ(cards_.openCards, 0);
  }
}

TEST_F(DisplayTest, TellsItsTimingBeforeItIsOpened) {
  plug({.connectors = {{.modes = {{.size = {64, 48}, .hertz = 50.0}}}}});
  const Result<DisplayTiming> timing = displayTiming("display", cards_);
  ASSERT_TRUE(timing.has_value());
  EXPECT_EQ(timing->size, (FrameSize{64, 48}));
  EXPECT_NEAR(toMilliseconds(timing->period), 20.0, 0.1);
  EXPECT_TRUE(timing->hasVblank);
  EXPECT_EQ(cards_.modesets, 0);
  ASSERT_TRUE(start().has_value()) << "it was released";
}

TEST_F(DisplayTest, TellsBeforehandThatItCountsNoRefreshes) {
  plug({.hasVblank = false});
  EXPECT_FALSE(displayTiming("display", cards_)->hasVblank);
}

TEST(DisplayListing, IsReadFromTheKernelsFiles) {
  const support::TemporaryFolder folder;
  const auto add = [&](const std::string& name, const std::string& status,
                       const std::string& modes) {
    std::filesystem::create_directory(folder.path() / name);
    std::ofstream(folder.path() / name / "status") << status;
    std::ofstream(folder.path() / name / "modes") << modes;
  };
  add("card0-HDMI-A-1", "connected\n", "1920x1080\n1920x1080\n1280x720\n1920x1080\n");
  add("card0-DP-1", "disconnected\n", "");
  add("card0-Writeback-1", "unknown\n", "");
  std::filesystem::create_directory(folder.path() / "card0");
  const OutputListing listing = listDisplays(folder.path());
  ASSERT_EQ(listing.outputs.size(), 2u);
  EXPECT_EQ(listing.outputs[0].target, "display:card0-DP-1");
  EXPECT_TRUE(listing.outputs[0].problem.has_value());
  EXPECT_EQ(listing.outputs[1].target, "display:card0-HDMI-A-1");
  EXPECT_FALSE(listing.outputs[1].problem.has_value());
  EXPECT_EQ(listing.outputs[1].formats, (std::vector<std::string>{"1920x1080", "1280x720"}));
}

TEST(DisplayListing, SaysThatThereIsNoCard) {
  const OutputListing none = listDisplays("/nowhere");
  ASSERT_TRUE(none.problem.has_value());
  EXPECT_EQ(none.problem->kind, ErrorKind::kNotFound);
}

TEST(CardUsers, AreTheProgramsThatHaveItOpen) {
  const support::TemporaryFolder proc;
  std::filesystem::create_directories(proc.path() / "712" / "fd");
  std::filesystem::create_symlink("/dev/dri/card0", proc.path() / "712" / "fd" / "7");
  std::ofstream(proc.path() / "712" / "comm") << "Xorg\n";
  EXPECT_EQ(display::usersText("/dev/dri/card0", proc.path()), "Xorg (712)");
  EXPECT_EQ(display::usersText("/dev/dri/card1", proc.path()), "");
}

TEST_F(DisplayTest, NamesNoDisplay) {
  EXPECT_FALSE(openDisplay("display:", {}, cards_, clock_).has_value());
}

}  // namespace
}  // namespace pleinair::hal
