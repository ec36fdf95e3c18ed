// When a display is darker, and how the fade goes.
#include "hal/outputs/display/dimming.h"

#include <algorithm>
#include <chrono>
#include <string>

#include "tests/unit/hal/outputs/display/display_test.h"

namespace pleinair::support {
namespace {

using namespace std::chrono_literals;
using hal::TimePoint;
using hal::display::DailyTimes;
using hal::display::Dimmer;
using hal::display::DimmingRules;

constexpr DimmingRules kEvening{.times = DailyTimes{.from = 20h, .to = 23h}, .level = 0.2};

TEST(DimmingLevel, IsANumberFromZeroToOne) {
  EXPECT_EQ(DimmingRules::parsedLevel("0.25"), 0.25);
  EXPECT_EQ(DimmingRules::parsedLevel("0"), 0.0);
  EXPECT_EQ(DimmingRules::parsedLevel("1"), 1.0);
  for (const char* wrong : {"", "1.01", "-0.1", "half", "0.5 ", "50%", "nan", "inf"}) {
    EXPECT_EQ(DimmingRules::parsedLevel(wrong), std::nullopt) << wrong;
  }
}

TEST(DimmingKeys, RefuseWhatIsNoTimeAndNoLevel) {
  const hal::OutputKind kind = hal::displayKind();
  const auto takes = [&kind](const std::string& key, const std::string& value) {
    const auto option = std::ranges::find(kind.options, key, &hal::OutputOption::name);
    return option != kind.options.end() && option->takes(option->initial) && option->takes(value);
  };
  EXPECT_TRUE(takes("dim", "20:00-23:00"));
  EXPECT_TRUE(takes("dim", "22:30-06:00")) << "over midnight";
  EXPECT_TRUE(takes("dim", "never"));
  for (const char* wrong : {"", "20-23", "20:00", "20:00-20:00", "24:00-01:00", "always"}) {
    EXPECT_FALSE(takes("dim", wrong)) << wrong;
  }
  EXPECT_TRUE(takes("dim_level", "0.15"));
  EXPECT_FALSE(takes("dim_level", "15"));
}

TEST(DimmerTest, FadesInAndOutOverFiveSeconds) {
  Dimmer dimmer(kEvening);
  const TimePoint start(1h);
  EXPECT_EQ(dimmer.level(start), 1.0) << "before anything is known";
  dimmer.follow(19h + 59min, start);
  EXPECT_EQ(dimmer.level(start + 1min), 1.0);
  dimmer.follow(20h, start + 1min);
  EXPECT_EQ(dimmer.level(start + 1min), 1.0);
  EXPECT_DOUBLE_EQ(dimmer.level(start + 1min + 2500ms), 0.6);
  dimmer.follow(20h, start + 1min + 4s);  // again and again, meanwhile
  EXPECT_EQ(dimmer.level(start + 1min + 5s), 0.2);
  dimmer.follow(22h + 59min, start + 10min);
  EXPECT_EQ(dimmer.level(start + 10min), 0.2);
  dimmer.follow(23h, start + 11min);
  EXPECT_DOUBLE_EQ(dimmer.level(start + 11min + 2500ms), 0.6);
  EXPECT_EQ(dimmer.level(start + 12min), 1.0);
}

TEST(DimmerTest, ShowsAtOnceWhatTheTimeAsksForAtTheStart) {
  Dimmer dimmer(kEvening);
  dimmer.follow(21h, TimePoint(1h));
  EXPECT_EQ(dimmer.level(TimePoint(1h)), 0.2);
}

TEST(DimmerTest, TurnsBackInMidFadeWithoutAJump) {
  Dimmer dimmer(kEvening);
  const TimePoint start(1h);
  dimmer.follow(19h, start);
  dimmer.follow(20h, start);
  const double halfway = dimmer.level(start + 2500ms);
  dimmer.follow({}, start + 2500ms);
  EXPECT_EQ(dimmer.level(start + 2500ms), halfway);
  EXPECT_GT(dimmer.level(start + 4s), halfway);
  EXPECT_EQ(dimmer.level(start + 8s), 1.0);
}

TEST(DimmerTest, WithoutTimesNeverDims) {
  Dimmer dimmer({.times = {}, .level = 0.2});
  dimmer.follow(21h, TimePoint(1h));
  EXPECT_EQ(dimmer.level(TimePoint(2h)), 1.0);
}

class DisplayBrightness : public DisplayTest {
 protected:
  /// As the pipeline does while nothing is shown.
  double brightnessAfter(hal::Duration time) {
    for (const TimePoint end = clock_.now() + time; clock_.now() < end;) {
      clock_.advance(100ms);
      EXPECT_TRUE(output_->takeEvents(events_).has_value());
    }
    return output_->brightness();
  }
};

TEST_F(DisplayBrightness, FollowsTheTimeOfDay) {
  plug();
  cards_.localTime = 12h;
  ASSERT_TRUE(start("display", {.placement = {}, .blanking = {}, .dimming = kEvening}).has_value());
  EXPECT_EQ(brightnessAfter(10s), 1.0);
  cards_.localTime = 20h;
  EXPECT_EQ(brightnessAfter(10s), 0.2);
  cards_.localTime = 23h;
  EXPECT_EQ(brightnessAfter(10s), 1.0);
}

TEST_F(DisplayBrightness, ADisplayThatComesInItsHoursIsDimmedFromItsFirstPictureOn) {
  plug();
  cards_.localTime = 21h;
  ASSERT_TRUE(start("display", {.placement = {}, .blanking = {}, .dimming = kEvening}).has_value());
  EXPECT_EQ(output_->brightness(), 0.2);
}

TEST_F(DisplayBrightness, AClockThatCannotBeRightDimsNothing) {
  plug();
  cards_.localTime.reset();
  ASSERT_TRUE(start("display", {.placement = {}, .blanking = {}, .dimming = kEvening}).has_value());
  EXPECT_EQ(brightnessAfter(10s), 1.0);
  cards_.localTime = 21h;
  EXPECT_EQ(brightnessAfter(10s), 0.2);
  cards_.localTime.reset();
  EXPECT_EQ(brightnessAfter(10s), 1.0);
}

}  // namespace
}  // namespace pleinair::support
