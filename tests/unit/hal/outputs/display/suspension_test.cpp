// Displays that another console or program takes over, that are switched off while nobody is there,
// and that the computer's own suspension has passed over.
#include <chrono>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/hal/outputs/display/display_test.h"

namespace pleinair::hal {
namespace {

using namespace std::chrono_literals;
using support::FakeCardSpec;
using support::kPainted;
using testing::HasSubstr;
using Cause = Suspension::Cause;

class SuspensionTest : public support::DisplayTest {
 protected:
  ~SuspensionTest() override { enterConsole(); }

  /// As the pipeline does while no surface is to be had.
  void attendFor(Duration time) {
    const TimePoint end = clock_.now() + time;
    while (clock_.now() < end) {
      clock_.advance(100ms);
      ASSERT_TRUE(output_->takeEvents(events_).has_value());
    }
  }
  std::optional<Cause> cause() const {
    const Suspension* suspension = output_->suspension();
    return suspension == nullptr ? std::nullopt : std::optional(suspension->cause);
  }
  std::size_t skipped() const {
    return static_cast<std::size_t>(std::ranges::count(events_, PresentationEvent::Result::kSkipped,
                                                       &PresentationEvent::result));
  }
};

TEST_F(SuspensionTest, AnotherConsoleIsSeenAndThenThePictureAgain) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_FALSE(card.showsConsole);

  leaveConsole();
  EXPECT_TRUE(card.showsConsole);
  ASSERT_TRUE(output_->takeEvents(events_).has_value());
  EXPECT_EQ(cause(), Cause::kConsole);
  EXPECT_THAT(output_->suspension()->reason, HasSubstr("console"));
  EXPECT_FALSE(output_->acquire()->has_value());
  attendFor(1h);
  EXPECT_TRUE(card.showsConsole) << "the card is left alone";
  EXPECT_EQ(cards_.modesets, 1);

  enterConsole();
  attendFor(100ms);
  EXPECT_EQ(cause(), std::nullopt);
  EXPECT_FALSE(card.showsConsole);
  EXPECT_EQ(cards_.modesets, 2);
  events_.clear();
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.shown.back().firstPixel, kPainted);
  EXPECT_EQ(events_.size(), 1u);
}

TEST_F(SuspensionTest, AConsoleThatComesDuringAFlipEndsWhatIsQueued) {
  plug();
  ASSERT_TRUE(start().has_value());
  const TimePoint due = clock_.now() + period_;
  ASSERT_TRUE(show(due).has_value());
  ASSERT_TRUE(runTo(due - period_ / 4).has_value());  // handed to the card, not shown
  ASSERT_TRUE(show(due + 5 * period_).has_value());
  ASSERT_EQ(cards_.flips, 1);
  leaveConsole();
  ASSERT_TRUE(runTo(due + 10 * period_).has_value());
  EXPECT_EQ(events_.size(), 2u) << "each submitted surface ends once";
  EXPECT_EQ(skipped(), 1u);
  enterConsole();
  attendFor(100ms);
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(events_.size(), 3u);
}

TEST_F(SuspensionTest, AFlipWhoseEventTheConsoleSwallowsEndsAllTheSame) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  card.losesFlips = true;
  ASSERT_TRUE(show(clock_.now() + period_).has_value());
  ASSERT_TRUE(runTo(clock_.now() + period_).has_value());
  ASSERT_EQ(cards_.flips, 1);
  card.hasOtherMaster = true;  // so that nothing brings it to an end
  leaveConsole();
  attendFor(2s);
  EXPECT_EQ(skipped(), 1u);
  card.losesFlips = false;
  card.hasOtherMaster = false;
  enterConsole();
  attendFor(100ms);
  events_.clear();
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(events_.size(), 1u);
}

TEST_F(SuspensionTest, ADisplayThatWasOffBeforeIsOffForTheOtherConsole) {
  FakeCardSpec& card = plug({.hasConsole = false});
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  leaveConsole();
  EXPECT_FALSE(card.isOn);
  enterConsole();
  attendFor(100ms);
  EXPECT_TRUE(card.isOn);
}

TEST_F(SuspensionTest, WhatWasLentBeforeEndsAtOnce) {
  plug();
  ASSERT_TRUE(start().has_value());
  const auto lent = output_->acquire();
  ASSERT_TRUE(lent->has_value());
  leaveConsole();
  ASSERT_TRUE(output_->submit(**lent, Fence(), clock_.now() + period_).has_value());
  ASSERT_TRUE(output_->takeEvents(events_).has_value());
  EXPECT_EQ(skipped(), 1u);
}

TEST_F(SuspensionTest, AConsoleThatWasThereBetweenTwoCallsIsNoticed) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  leaveConsole();
  enterConsole();
  EXPECT_TRUE(card.showsConsole);
  attendFor(200ms);  // without a picture
  EXPECT_FALSE(card.showsConsole);
  EXPECT_EQ(cause(), std::nullopt);
}

TEST_F(SuspensionTest, AStormOfSwitchesLeavesNothingBehind) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  for (int i = 0; i < 200; ++i) {
    leaveConsole();
    if (i % 3 != 0) attendFor(100ms);
    enterConsole();
    if (i % 2 == 0) continue;
    ASSERT_TRUE(showAndWait().has_value());
  }
  attendFor(200ms);
  EXPECT_EQ(cause(), std::nullopt);
  events_.clear();
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(events_.size(), 1u);
  EXPECT_EQ(cards_.buffers, 3);
  EXPECT_EQ(cards_.blobs, 1);
  EXPECT_TRUE(card.isOn);
}

TEST_F(SuspensionTest, AnotherMasterSuspendsUntilItGoes) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  card.hasOtherMaster = true;
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cause(), Cause::kConsole);
  EXPECT_THAT(output_->suspension()->reason, HasSubstr("another program"));
  EXPECT_EQ(skipped(), 1u);
  attendFor(10s);
  EXPECT_EQ(cause(), Cause::kConsole);
  card.hasOtherMaster = false;
  attendFor(1100ms);
  EXPECT_EQ(cause(), std::nullopt);
  EXPECT_TRUE(showAndWait().has_value());
}

TEST_F(SuspensionTest, ADisplayIsNotStartedWhileAnotherConsoleIsInFront) {
  FakeCardSpec& card = plug();
  leaveConsole();
  const Result<OutputFormat> refused = start();
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().kind, ErrorKind::kBusy);
  EXPECT_THAT(refused.error().message(), HasSubstr("another console"));
  EXPECT_TRUE(card.showsConsole);
  enterConsole();
  EXPECT_TRUE(start().has_value());
}

TEST_F(SuspensionTest, TheEndWhileAnotherConsoleIsInFrontLeavesItAlone) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  leaveConsole();
  const int restores = cards_.restores;
  EXPECT_TRUE(output_->finish().has_value());
  output_.reset();
  EXPECT_EQ(cards_.restores, restores);
  EXPECT_TRUE(card.showsConsole);
  EXPECT_EQ(cards_.openCards, 0);
}

TEST_F(SuspensionTest, ADisplayThatIsUnpluggedMeanwhileIsLost) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start().has_value());
  leaveConsole();
  ASSERT_TRUE(output_->takeEvents(events_).has_value());
  card.connectors.front().isConnected = false;
  clock_.advance(1s);
  const auto taken = output_->takeEvents(events_);
  ASSERT_FALSE(taken.has_value());
  EXPECT_EQ(taken.error().kind, ErrorKind::kDeviceLost);
}

TEST_F(SuspensionTest, AComputerThatWasSuspendedGetsItsModeAgain) {
  plug();
  ASSERT_TRUE(start().has_value());
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.modesets, 1);
  cards_.suspended += 8h;
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.modesets, 2);
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(cards_.modesets, 2);
  EXPECT_EQ(cards_.shown.back().firstPixel, kPainted);
}

class BlankingTest : public SuspensionTest {
 protected:
  static DisplaySettings after(Duration quiet) {
    return {.blanking = {.times = {}, .after = quiet}};
  }
};

TEST_F(BlankingTest, GoesOffWhenNobodyHasBeenThereAndOnAtOnceForSomebody) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", after(10s)).has_value());
  ASSERT_TRUE(showAndWait().has_value());
  attendFor(9s);
  EXPECT_TRUE(card.isOn);
  attendFor(1s);
  EXPECT_FALSE(card.isOn);
  EXPECT_EQ(cause(), Cause::kBlank);
  EXPECT_THAT(output_->suspension()->reason, HasSubstr("10.0 s"));
  EXPECT_FALSE(output_->acquire()->has_value());
  attendFor(1h);
  EXPECT_FALSE(card.isOn);
  EXPECT_EQ(cards_.switchedOff, 1);
  EXPECT_EQ(cards_.modesets, 1);

  output_->noteActivity();
  ASSERT_TRUE(output_->takeEvents(events_).has_value());
  EXPECT_TRUE(card.isOn);
  EXPECT_EQ(cause(), std::nullopt);
  EXPECT_EQ(cards_.modesets, 2);
  events_.clear();
  ASSERT_TRUE(showAndWait().has_value());
  EXPECT_EQ(events_.size(), 1u);
}

TEST_F(BlankingTest, SomebodyWhoStaysKeepsItOnWithoutAFlicker) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", {.blanking = {.times = {}, .after = 2s}}).has_value());
  for (int i = 0; i < 600; ++i) {
    output_->noteActivity();
    attendFor(1s);
    ASSERT_TRUE(card.isOn);
  }
  EXPECT_EQ(cards_.switchedOff, 0);
  EXPECT_EQ(cards_.modesets, 1);
}

TEST_F(BlankingTest, TheOldPictureIsNotSeenWhenItGoesOn) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", after(1s)).has_value());
  ASSERT_TRUE(showAndWait().has_value());
  attendFor(2s);
  ASSERT_FALSE(card.isOn);
  EXPECT_EQ(card.firstPixel(), 0u);
}

TEST_F(BlankingTest, ByTheTimeOfDayItWaitsForPeopleToGo) {
  FakeCardSpec& card = plug();
  cards_.localTime = 21h + 59min;
  const auto times = display::DailyTimes::parsed("22:00-08:00");
  ASSERT_TRUE(start("display", {.blanking = {.times = times, .after = {}}}).has_value());
  attendFor(5min);
  EXPECT_TRUE(card.isOn);
  output_->noteActivity();
  cards_.localTime = 22h;
  attendFor(59s);
  EXPECT_TRUE(card.isOn) << "somebody was there a minute ago";
  attendFor(3s);
  EXPECT_FALSE(card.isOn);
  output_->noteActivity();
  attendFor(100ms);
  EXPECT_TRUE(card.isOn);
  attendFor(62s);
  EXPECT_FALSE(card.isOn);
  cards_.localTime = 8h;
  attendFor(1100ms);
  EXPECT_TRUE(card.isOn);
  EXPECT_EQ(cause(), std::nullopt);
}

TEST_F(BlankingTest, UnpluggedWhileItIsOffItComesBackOff) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", after(5s)).has_value());
  attendFor(6s);
  ASSERT_FALSE(card.isOn);
  card.connectors.front().isConnected = false;
  clock_.advance(1s);
  EXPECT_FALSE(output_->takeEvents(events_).has_value());
  output_.reset();
  card.connectors.front().isConnected = true;
  ASSERT_TRUE(start("display", after(5s)).has_value());
  attendFor(100ms);
  EXPECT_FALSE(card.isOn) << "many a monitor unplugs itself when it is switched off";
  output_->noteActivity();
  attendFor(100ms);
  EXPECT_TRUE(card.isOn);
}

TEST_F(BlankingTest, AFlipInProgressIsWaitedFor) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", after(1s)).has_value());
  const TimePoint last = clock_.now() + 1s;
  ASSERT_TRUE(show(last).has_value());
  ASSERT_TRUE(runTo(last + 3 * period_).has_value());
  EXPECT_FALSE(card.isOn);
  EXPECT_EQ(events_.size(), 1u);
}

TEST_F(BlankingTest, AConsoleMayComeAndGoMeanwhile) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", after(5s)).has_value());
  attendFor(6s);
  ASSERT_FALSE(card.isOn);
  leaveConsole();
  EXPECT_TRUE(card.showsConsole);
  attendFor(10s);
  EXPECT_TRUE(card.showsConsole);
  enterConsole();
  output_->noteActivity();
  attendFor(100ms);
  EXPECT_TRUE(card.isOn);
  EXPECT_FALSE(card.showsConsole);
}

TEST_F(BlankingTest, TheConsoleIsBackAtTheEnd) {
  FakeCardSpec& card = plug();
  ASSERT_TRUE(start("display", after(1s)).has_value());
  attendFor(2s);
  ASSERT_FALSE(card.isOn);
  ASSERT_TRUE(output_->finish().has_value());
  EXPECT_TRUE(card.showsConsole);
}

TEST(DailyTimes, MayPassMidnight) {
  const auto night = display::DailyTimes::parsed("22:00-08:00");
  ASSERT_TRUE(night.has_value());
  EXPECT_TRUE(night->contain(22h));
  EXPECT_TRUE(night->contain(0h));
  EXPECT_TRUE(night->contain(7h + 59min));
  EXPECT_FALSE(night->contain(8h));
  EXPECT_FALSE(night->contain(21h + 59min));
  const auto noon = display::DailyTimes::parsed("12:00-13:30");
  EXPECT_TRUE(noon->contain(13h));
  EXPECT_FALSE(noon->contain(13h + 30min));
  EXPECT_FALSE(noon->contain(0h));
}

TEST(DailyTimes, AreTwoTimes) {
  for (const char* wrong : {"", "22:00", "22:00-", "24:00-08:00", "22:60-08:00", "8:00-09:00",
                            "22:00-22:00", "22-08", "never", "22:00-08:00-10:00"}) {
    EXPECT_FALSE(display::DailyTimes::parsed(wrong).has_value()) << wrong;
  }
}

TEST(QuietTime, IsSecondsOrNever) {
  EXPECT_EQ(display::QuietTime::parsed("300")->after, Duration(300s));
  EXPECT_EQ(display::QuietTime::parsed("never")->after, std::nullopt);
  for (const char* wrong : {"", "0", "-5", "1.5", "86401", "soon"}) {
    EXPECT_FALSE(display::QuietTime::parsed(wrong).has_value()) << wrong;
  }
}

}  // namespace
}  // namespace pleinair::hal
