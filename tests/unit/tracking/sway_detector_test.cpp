#include "pipeline/tracking/motion/sway_detector.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::tracking {
namespace {

constexpr hal::FrameSize kSize{320, 240};
/// How a feature has moved from its place: by a number of its own, in [0, 1], and the time.
using Motion = std::function<glm::dvec2(glm::dvec2 px, double own, double seconds)>;

struct Film {
  double noisePx = 0.03;
  double framesPerSecond = 15.0;
  int frames = 90;
};

constexpr int kJudged = 60;  // frames

/// How many of the last kJudged frames are taken for those of a camera that stands. Features lie on
/// a grid.
int standingFrames(const Motion& motion, const Film& film = {}) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0.0, film.noisePx);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> own(std::size_t{16} * 12);
  for (double& each : own) each = unit(random);
  SwayDetector detector;
  int standing = 0;
  for (int frame = 0; frame < film.frames; ++frame) {
    std::vector<SeenFeature> seen;
    for (std::size_t i = 0; i < own.size(); ++i) {
      const glm::dvec2 place(20.0 * static_cast<double>(i % 16) + 10.0,
                             20.0 * static_cast<double>(i / 16) + 10.0);
      const glm::dvec2 px = place + motion(place, own[i], frame / film.framesPerSecond) +
                            glm::dvec2(noise(random), noise(random));
      seen.push_back({.id = static_cast<std::uint32_t>(i),
                      .px = px,
                      .errorPx = 1.5 * film.noisePx,
                      .wasSeen = frame > 0});
    }
    const bool stands = detector.stands(seen, kSize, 1.0);
    standing += stands && frame >= film.frames - kJudged ? 1 : 0;
  }
  return standing;
}

glm::dvec2 swayed(double own, double seconds) {
  return glm::dvec2(1.0, 0.4) *
         std::sin(2.0 * std::numbers::pi * (own + (0.3 + 0.4 * own) * seconds));
}

TEST(SwayDetector, ACameraStandsBeforeLeaves) {
  const auto leaves = [](glm::dvec2, double own, double t) { return swayed(own, t); };
  EXPECT_EQ(standingFrames(leaves), kJudged);
  EXPECT_EQ(standingFrames(leaves, {.framesPerSecond = 30.0}), kJudged);
  // It takes longer to see that they come back.
  EXPECT_EQ(standingFrames(leaves, {.framesPerSecond = 60.0, .frames = 300}), kJudged);
}

/// All leaves go with the wind, and scatter besides.
TEST(SwayDetector, AlsoWhereTheWindBendsThemAll) {
  const auto bent = [](glm::dvec2, double own, double t) {
    return swayed(own, t) + glm::dvec2(0.2 * std::sin(2.0 * t), 0.0);
  };
  EXPECT_EQ(standingFrames(bent), kJudged);
}

TEST(SwayDetector, ACameraThatMovesDoesNotStand) {
  for (const double noise : {0.03, 0.1, 0.15}) {
    for (const double step : {0.005, 0.01, 0.02, 0.1, 1.5, -8.0}) {
      const auto panned = [step](glm::dvec2, double, double t) {
        return glm::dvec2(step * 15.0 * t, 0.0);
      };
      EXPECT_EQ(standingFrames(panned, {.noisePx = noise, .frames = 300}), 0)
          << step << " px a frame, noise of " << noise;
    }
  }
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
  const auto moved = [](glm::dvec2, double own, double t) {
    return 0.5 * swayed(own, t) + glm::dvec2(6.0 * t, 0.0);
  };
  EXPECT_EQ(standingFrames(moved), 0);
}

/// A camera that goes around a thing moves what is near and what is far in opposite ways: no
/// similarity takes them along.
TEST(SwayDetector, NorOneThatPassesNearAndFarThings) {
  for (const double step : {0.025, 0.05, 0.1, 0.15, 1.0}) {
    const auto parallax = [step](glm::dvec2, double own, double t) {
      return glm::dvec2((own - 0.5) * 2.0 * step * 15.0 * t, 0.0);
    };
    EXPECT_EQ(standingFrames(parallax, {.frames = 300}), 0) << step;
  }
}

/// A camera that is picked up after it has stood.
TEST(SwayDetector, NorOneThatStoodAndMovesNow) {
  const auto moved = [](glm::dvec2, double own, double t) {
    return swayed(own, t) + glm::dvec2(std::max(0.0, t - 5.0) * 9.0, 0.0);
  };
  EXPECT_LE(standingFrames(moved, {.frames = 140}), 4) << "it begins at frame 75";
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
