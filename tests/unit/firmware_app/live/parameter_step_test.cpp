#include "firmware_app/live/interaction/parameter_step.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace pleinair::app {
namespace {

using config::ChoiceIndex;
using config::ParameterDescriptor;
using config::ParameterValue;

constexpr bool kLarge = true;

ParameterDescriptor number(double min, double max, double value = 0) {
  return {.name = "n", .defaultValue = value, .numberRange = {.min = min, .max = max}};
}
ParameterDescriptor integer(int min, int max) {
  return {.name = "i", .defaultValue = min, .integerRange = {.min = min, .max = max}};
}

/// The value after `count` steps, or fewer if it stops, as a person writes it.
std::string after(const ParameterDescriptor& descriptor, ParameterValue value, int count,
                  bool large = false) {
  for (int i = 0; i < std::abs(count); ++i) {
    const auto next = stepped(descriptor, value, count > 0 ? 1 : -1, large);
    if (!next) break;
    EXPECT_TRUE(descriptor.allows(*next));
    value = *next;
  }
  return descriptor.textOf(value);
}

TEST(ParameterStep, GoesByAHundredthOfTheRange) {
  const ParameterDescriptor part = number(0, 1);
  EXPECT_EQ(after(part, 0.5, 1), "0.51");
  EXPECT_EQ(after(part, 0.5, -1), "0.49");
  EXPECT_EQ(after(part, 0.5, 1, kLarge), "0.6");
  EXPECT_EQ(after(part, 0.5, -1, kLarge), "0.4");
}

TEST(ParameterStep, RoundsTheStepToWhatPeopleCountIn) {
  EXPECT_EQ(after(number(0, 4), 2.0, 1), "2.02");
  EXPECT_EQ(after(number(0, 10), 2.0, 1), "2.1");
  EXPECT_EQ(after(number(0, 60), 2.0, 1), "2.5");
  EXPECT_EQ(after(number(2, 64), 8.0, 1), "8.5");
  EXPECT_EQ(after(number(0, 5000), 100.0, 1), "150");
  EXPECT_EQ(after(number(0, 1e-3), 0.0, 1), "1e-05");
}

TEST(ParameterStep, LandsOnMultiplesAndShowsNoRoundingErrors) {
  const ParameterDescriptor part = number(0, 1);
  EXPECT_EQ(after(part, 0.123, 1), "0.13");
  EXPECT_EQ(after(part, 0.123, -1), "0.12");
  EXPECT_EQ(after(part, 0.0, 30), "0.3");
  for (int i = 0; i <= 100; ++i) {
    const std::string text = after(part, 0.0, i);
    EXPECT_LE(text.size(), 4u) << text;
    EXPECT_EQ(after(part, *part.parse(text), -i), "0") << "back again";
  }
}

TEST(ParameterStep, StopsAtTheEndsOfTheRange) {
  const ParameterDescriptor odd = number(0.005, 0.997);
  EXPECT_EQ(after(odd, 0.5, 1000), "0.997");
  EXPECT_EQ(after(odd, 0.5, -1000), "0.005");
  EXPECT_FALSE(stepped(odd, 0.997, 1, false));
  EXPECT_FALSE(stepped(odd, 0.005, -1, kLarge));
  EXPECT_EQ(after(number(-1, 1), 0.1, -1, kLarge), "0") << "not −0";
}

TEST(ParameterStep, StaysOffOpenEnds) {
  ParameterDescriptor open = number(0, 1);
  open.numberRange.minOpen = true;
  open.numberRange.maxOpen = true;
  EXPECT_EQ(after(open, 0.5, -1000), "0.01");
  EXPECT_EQ(after(open, 0.5, 1000), "0.99");
}

TEST(ParameterStep, DoesWithoutEndsOfTheRange) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const ParameterDescriptor endless = number(-kInfinity, kInfinity);
  EXPECT_EQ(after(endless, 0.5, 1), "0.51");
  EXPECT_EQ(after(endless, 300.0, 1), "302");
  EXPECT_EQ(after(endless, 300.0, -1, kLarge), "280");
  EXPECT_EQ(after(number(0, kInfinity), 0.02, -1000), "0");
}

TEST(ParameterStep, CountsIntegersByOneAndTen) {
  const ParameterDescriptor cells = integer(4, 64);
  EXPECT_EQ(after(cells, 8, 1), "9");
  EXPECT_EQ(after(cells, 8, -1), "7");
  EXPECT_EQ(after(cells, 8, 1, kLarge), "18");
  EXPECT_EQ(after(cells, 8, -1, kLarge), "4");
  EXPECT_EQ(after(cells, 60, 1, kLarge), "64");
  EXPECT_FALSE(stepped(cells, 64, 1, false));
  const int largest = std::numeric_limits<int>::max();
  EXPECT_FALSE(stepped(integer(0, largest), largest, 1, kLarge)) << "and does not overflow";
}

TEST(ParameterStep, TurnsSwitchesOver) {
  const ParameterDescriptor paper{.name = "s", .defaultValue = true};
  for (const int direction : {1, -1}) {
    EXPECT_EQ(stepped(paper, true, direction, false), ParameterValue(false));
    EXPECT_EQ(stepped(paper, false, direction, kLarge), ParameterValue(true));
  }
}

TEST(ParameterStep, GoesRoundChoices) {
  const ParameterDescriptor three{
      .name = "c", .defaultValue = ChoiceIndex{0}, .choices = {"a", "b", "c"}};
  EXPECT_EQ(after(three, ChoiceIndex{0}, 1), "b");
  EXPECT_EQ(after(three, ChoiceIndex{2}, 1), "a");
  EXPECT_EQ(after(three, ChoiceIndex{0}, -1), "c");
  const ParameterDescriptor one{.name = "c", .defaultValue = ChoiceIndex{0}, .choices = {"a"}};
  EXPECT_FALSE(stepped(one, ChoiceIndex{0}, 1, false));
}

}  // namespace
}  // namespace pleinair::app
