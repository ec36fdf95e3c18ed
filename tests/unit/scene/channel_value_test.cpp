// Values of channels between their keys, computed by hand and by the formulas of glTF 2.0, appendix
// C.
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gmock/gmock.h>

#include "pipeline/scene/models/rig.h"

namespace pleinair::scene {
namespace {

std::vector<double> at(const Channel& channel, double seconds) {
  std::vector<double> value(channel.width);
  valueAt(channel, seconds, value);
  return value;
}

auto near(std::vector<double> expected, double tolerance = 1e-6) {
  return testing::Pointwise(testing::DoubleNear(tolerance), std::move(expected));
}

/// Keys at 1, 2 and 4 s.
Channel moves(Interpolation interpolation) {
  Channel channel{.interpolation = interpolation, .seconds = {1, 2, 4}};
  channel.values = {0, 0, 0, 10, 20, 30, 10, -20, 30};
  return channel;
}

TEST(ChannelValue, OfStepsIsTheLastKeys) {
  const Channel channel = moves(Interpolation::kStep);
  EXPECT_THAT(at(channel, 1.999), near({0, 0, 0}));
  EXPECT_THAT(at(channel, 2.0), near({10, 20, 30}));
  EXPECT_THAT(at(channel, 3.999), near({10, 20, 30}));
  EXPECT_THAT(at(channel, 4.0), near({10, -20, 30}));
}

TEST(ChannelValue, OfLinesGoesEvenlyFromKeyToKey) {
  const Channel channel = moves(Interpolation::kLinear);
  EXPECT_THAT(at(channel, 1.25), near({2.5, 5, 7.5}));
  EXPECT_THAT(at(channel, 2.0), near({10, 20, 30}));
  EXPECT_THAT(at(channel, 3.0), near({10, 0, 30}));
}

TEST(ChannelValue, StandsStillBeforeItsKeysAndAfter) {
  for (const auto kind : {Interpolation::kStep, Interpolation::kLinear}) {
    for (const double before : {-1.0, 0.0, 0.999, 1.0}) {
      EXPECT_THAT(at(moves(kind), before), near({0, 0, 0}));
    }
    for (const double after : {4.0, 4.001, 1e9}) {
      EXPECT_THAT(at(moves(kind), after), near({10, -20, 30}));
    }
  }
}

TEST(ChannelValue, OfASingleKeyIsThatKeys) {
  Channel channel{.interpolation = Interpolation::kLinear, .seconds = {3}, .values = {1, 2, 3}};
  for (const double when : {0.0, 3.0, 9.0}) EXPECT_THAT(at(channel, when), near({1, 2, 3}));
  channel.interpolation = Interpolation::kCubicSpline;
  channel.values = {9, 9, 9, 1, 2, 3, 9, 9, 9};
  for (const double when : {0.0, 3.0, 9.0}) EXPECT_THAT(at(channel, when), near({1, 2, 3}));
}

Channel turns(Interpolation interpolation, std::vector<float> values) {
  return {.property = AnimatedProperty::kRotation,
          .interpolation = interpolation,
          .seconds = {0, 1},
          .values = std::move(values),
          .width = 4};
}

/// A rotation about z.
std::array<float, 4> turnedBy(double degrees) {
  const double half = degrees * std::numbers::pi / 360.0;
  return {0, 0, static_cast<float>(std::sin(half)), static_cast<float>(std::cos(half))};
}

TEST(ChannelValue, OfTurnsGoesEvenlyRound) {
  const auto to = turnedBy(120.0);
  const Channel channel = turns(Interpolation::kLinear, {0, 0, 0, 1, to[0], to[1], to[2], to[3]});
  for (const double t : {0.1, 0.25, 0.5, 0.9}) {
    const auto turned = turnedBy(120.0 * t);
    EXPECT_THAT(at(channel, t), near({0, 0, turned[2], turned[3]}));
  }
}

TEST(ChannelValue, OfTurnsGoesTheShorterWay) {
  const auto to = turnedBy(270.0);  // the same as −90°
  const Channel channel = turns(Interpolation::kLinear, {0, 0, 0, 1, to[0], to[1], to[2], to[3]});
  const auto turned = turnedBy(-45.0);
  EXPECT_THAT(at(channel, 0.5), near({0, 0, turned[2], turned[3]}));
  const Channel same = turns(Interpolation::kLinear, {0, 0, 0, 1, 0, 0, 0, -1});
  // The same rotation with the opposite sign must not go the long way.
  const auto value = at(same, 0.3);
  EXPECT_NEAR(std::abs(value[3]), 1.0, 1e-9);
}

TEST(ChannelValue, OfTurnsIsOfUnitLength) {
  // such as normalised bytes give
  for (const auto kind : {Interpolation::kStep, Interpolation::kLinear}) {
    const Channel channel = turns(kind, {0, 0, 0, 0.9F, 0, 0, 0.71F, 0.7F});
    for (const double t : {0.0, 0.3, 1.0}) {
      const auto value = at(channel, t);
      EXPECT_NEAR(value[2] * value[2] + value[3] * value[3], 1.0, 1e-12);
    }
  }
}

TEST(ChannelValue, OfASplineFollowsItsTangents) {
  // from 1 to 3 in 2 s; leaves with slope 4, arrives with slope −2
  const Channel channel{.property = AnimatedProperty::kWeights,
                        .interpolation = Interpolation::kCubicSpline,
                        .seconds = {0, 2},
                        .values = {77, 1, 4, -2, 3, 88},
                        .width = 1};
  EXPECT_THAT(at(channel, 0.0), near({1}));
  // by hand at t = 1/2: 1/2 · 1 + 2 · 1/8 · 4 + 1/2 · 3 − 2 · 1/8 · (−2)
  EXPECT_THAT(at(channel, 1.0), near({3.5}));
  EXPECT_THAT(at(channel, 2.0), near({3}));
  const double step = 1e-6;
  EXPECT_NEAR((at(channel, step)[0] - 1.0) / step, 4.0, 1e-4);
  EXPECT_NEAR((3.0 - at(channel, 2.0 - step)[0]) / step, -2.0, 1e-4);
}

TEST(ChannelValue, OfASplineOfTurnsIsARotation) {
  // half way between opposite turns the formula gives nothing
  const Channel opposite =
      turns(Interpolation::kCubicSpline,
            {0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, -1, 0, 0, 0, 0});
  EXPECT_THAT(at(opposite, 0.5), near({0, 0, 0, 1}));
}

/// Appendix C.5, of random keys, one number at a time.
TEST(ChannelValue, OfSplinesIsTheSpecificationsFormula) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> number(-3.0F, 3.0F);
  Channel channel{.interpolation = Interpolation::kCubicSpline};
  float when = 0.0F;
  for (int key = 0; key < 20; ++key) {
    channel.seconds.push_back(when += 0.01F + std::abs(number(random)));
    for (int i = 0; i < 9; ++i) channel.values.push_back(number(random));
  }
  for (std::size_t k = 0; k + 1 < channel.seconds.size(); ++k) {
    for (const double t : {0.0, 0.2, 0.7}) {
      const double td = static_cast<double>(channel.seconds[k + 1]) - channel.seconds[k];
      std::vector<double> expected;
      for (std::size_t i = 0; i < 3; ++i) {
        const double vk = channel.values[9 * k + 3 + i];
        const double bk = channel.values[9 * k + 6 + i];
        const double vk1 = channel.values[9 * (k + 1) + 3 + i];
        const double ak1 = channel.values[9 * (k + 1) + i];
        expected.push_back((2 * t * t * t - 3 * t * t + 1) * vk +
                           td * (t * t * t - 2 * t * t + t) * bk +
                           (-2 * t * t * t + 3 * t * t) * vk1 + td * (t * t * t - t * t) * ak1);
      }
      EXPECT_THAT(at(channel, channel.seconds[k] + t * td), near(expected, 1e-9));
    }
  }
}

}  // namespace
}  // namespace pleinair::scene
