#include "pipeline/tracking/motion/sway_detector.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::tracking {
namespace {

constexpr hal::FrameSize kSize{320, 240};
constexpr double kFramesPerSecond = 15.0;

/// How many of the last 40 of 60 frames are taken for those of a camera that stands. Features lie
/// on a grid; `movedBy` gives what they have moved by, of their place, a number of their own, and
/// the time in s.
int standingFrames(
    const std::function<glm::dvec2(glm::dvec2 px, double own, double seconds)>& movedBy,
    double noisePx = 0.03) {
  constexpr int kFrames = 60;
  constexpr int kFirst = 20;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, noisePx);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> own(16 * 12);
  for (double& each : own) each = unit(random);
  SwayDetector detector;
  int standing = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    std::vector<SeenFeature> seen;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const glm::dvec2 place(20.0 * static_cast<double>(i % 16) + 10.0,
                             20.0 * static_cast<double>(i / 16) + 10.0);
      const glm::dvec2 px = place + movedBy(place, own[i], frame / kFramesPerSecond) +
                            glm::dvec2(noise(random), noise(random));
      seen.push_back({.id = static_cast<std::uint32_t>(i), .px = px, .wasSeen = frame > 0});
    }
    standing += detector.stands(seen, kSize, 1.0) && frame >= kFirst ? 1 : 0;
  }
  return standing;
}

glm::dvec2 swayed(double own, double seconds) {
  return glm::dvec2(1.0, 0.4) *
         std::sin(2.0 * std::numbers::pi * (own + (0.3 + 0.4 * own) * seconds));
}

TEST(SwayDetector, ACameraStandsBeforeLeaves) {
  EXPECT_EQ(standingFrames([](glm::dvec2, double own, double t) { return swayed(own, t); }), 40);
}

/// All leaves go with the wind at first, and a part of them scatters.
TEST(SwayDetector, AlsoWhereTheWindBendsThemAll) {
  EXPECT_EQ(standingFrames([](glm::dvec2, double own, double t) {
              return swayed(own, t) + glm::dvec2(0.2 * std::sin(2.0 * t), 0.0);
            }),
            40);
}

TEST(SwayDetector, ACameraThatMovesDoesNotStand) {
  const auto panned = [](double pxPerFrame) {
    return [pxPerFrame](glm::dvec2, double, double t) {
      return glm::dvec2(pxPerFrame * kFramesPerSecond * t, 0.0);
    };
  };
  for (const double step : {0.02, 0.1, 1.5, -8.0})
    EXPECT_EQ(standingFrames(panned(step)), 0) << step;
  const auto zoomed = [](glm::dvec2 px, double, double t) {
    return 0.03 * t * (px - glm::dvec2(160.0, 120.0));
  };
  EXPECT_EQ(standingFrames(zoomed), 0);
  const auto shaken = [](glm::dvec2, double, double t) {
    return glm::dvec2(0.5 * std::sin(17.0 * t), 0.4 * std::sin(13.0 * t));
  };
  EXPECT_EQ(standingFrames(shaken), 0);
}

TEST(SwayDetector, NorOneThatMovesBeforeLeaves) {
  EXPECT_EQ(standingFrames([](glm::dvec2, double own, double t) {
              return 0.5 * swayed(own, t) + glm::dvec2(0.4 * kFramesPerSecond * t, 0.0);
            }),
            0);
}

/// Near and far things that a camera passes are no leaves: they scatter by more and more.
TEST(SwayDetector, NorOneThatPassesNearAndFarThings) {
  EXPECT_EQ(standingFrames([](glm::dvec2, double own, double t) {
              return glm::dvec2((own - 0.5) * 2.0 * kFramesPerSecond * t, 0.0);
            }),
            0);
}

TEST(SwayDetector, FewFeaturesSayNothing) {
  SwayDetector detector;
  for (int frame = 0; frame < 40; ++frame) {
    std::vector<SeenFeature> seen;
    for (std::uint32_t i = 0; i < 20; ++i) {
      seen.push_back(
          {.id = i, .px = glm::dvec2(16.0 * i, 12.0 * i) + swayed(0.05 * i, 0.066 * frame)});
    }
    ASSERT_FALSE(detector.stands(seen, kSize, 1.0)) << frame;
  }
}

}  // namespace
}  // namespace pleinair::tracking
