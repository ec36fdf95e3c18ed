#include "pipeline/tracking/motion/canvas_motion.h"

#include <algorithm>
#include <cmath>
#include <ostream>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/tracking/motion/image_motion_estimator.h"

namespace pleinair::tracking {
namespace {

constexpr hal::FrameSize kSize{320, 240};

/// A wall with patches of all sizes, in grey levels.
double wallAt(glm::dvec2 p) {
  double value = 120.0;
  for (const double size : {70.0, 31.0, 17.0}) {
    const glm::dvec2 cell = glm::floor(p / size);
    const double random = std::sin(cell.x * 127.1 + cell.y * 311.7 + size) * 43758.5453;
    value += 70.0 * (random - std::floor(random) - 0.5);
  }
  return value;
}

/// The view of a camera that has turned, zoomed and shifted, with 2×2 samples per pixel.
std::vector<std::uint8_t> seen(const PlaneSimilarity& wallFromFrame, double noise = 0.0,
                               unsigned seed = 1) {
  std::vector<std::uint8_t> luma;
  std::mt19937 random(seed);
  std::normal_distribution<double> level(0.0, std::max(noise, 1e-9));
  for (int y = 0; y < kSize.height; ++y) {
    for (int x = 0; x < kSize.width; ++x) {
      double sum = 0.0;
      for (const double v : {0.25, 0.75}) {
        for (const double u : {0.25, 0.75}) sum += 0.25 * wallAt(wallFromFrame({x + u, y + v}));
      }
      luma.push_back(static_cast<std::uint8_t>(std::clamp(sum + level(random), 0.0, 255.0)));
    }
  }
  return luma;
}

class Follower {
 public:
  const PlaneSimilarity& see(const std::vector<std::uint8_t>& luma, hal::FrameSize size = kSize) {
    const hal::PlaneView plane{.bytes = luma, .strideBytes = static_cast<std::size_t>(size.width)};
    return motion_.follow(estimator_.follow(plane, size, number_++));
  }
  void reset() {
    motion_.reset();
    estimator_.reset();
  }

 private:
  CanvasMotion motion_;
  ImageMotionEstimator estimator_{{.flow = false, .staticRegions = false}};
  std::uint64_t number_ = 0;
};

/// The largest distance of a frame corner's positions under two similarities.
double apart(const PlaneSimilarity& a, const PlaneSimilarity& b) {
  double most = 0.0;
  for (const double x : {0.0, 320.0}) {
    for (const double y : {0.0, 240.0}) most = std::max(most, glm::distance(a({x, y}), b({x, y})));
  }
  return most;
}

PlaneSimilarity turned(double degrees, double zoom, glm::dvec2 shift) {
  const double angle = degrees * 3.14159265358979 / 180.0;
  const glm::dvec2 linear = zoom * glm::dvec2(std::cos(angle), std::sin(angle));
  const glm::dvec2 middle(160.0, 120.0);
  return {linear, middle - PlaneSimilarity::product(linear, middle) + shift};
}

TEST(PlaneSimilarity, ComposesAndInverts) {
  const PlaneSimilarity a = turned(25.0, 1.3, {4.0, -7.0});
  const PlaneSimilarity b = turned(-70.0, 0.4, {1.0, 2.0});
  const glm::dvec2 p(12.0, 34.0);
  EXPECT_NEAR(glm::distance((a * b)(p), a(b(p))), 0.0, 1e-9);
  EXPECT_NEAR(glm::distance(a.inverse()(a(p)), p), 0.0, 1e-9);
  EXPECT_NEAR(a.scale(), 1.3, 1e-12);
}

struct Path {
  const char* name;
  double degrees;
  double zoom;
  glm::dvec2 shift;
  friend std::ostream& operator<<(std::ostream& out, const Path& path) { return out << path.name; }
};

class FollowTest : public testing::TestWithParam<Path> {};

// Each motion runs over several key frames.
INSTANTIATE_TEST_SUITE_P(Paths, FollowTest,
                         testing::Values(Path{"pan", 0.0, 1.0, {7.1, 1.7}},
                                         Path{"roll", 2.5, 1.0, {0.0, 0.0}},
                                         Path{"zoom", 0.0, 0.985, {0.0, 0.0}},
                                         Path{"all", 1.2, 1.015, {3.5, -2.0}}),
                         [](const auto& each) { return std::string(each.param.name); });

TEST_P(FollowTest, FindsTheMotion) {
  const Path& path = GetParam();
  Follower follower;
  double worst = 0.0;
  for (int i = 0; i < 16; ++i) {
    const PlaneSimilarity truth =
        turned(path.degrees * i, std::pow(path.zoom, i), path.shift * static_cast<double>(i));
    worst = std::max(worst, apart(follower.see(seen(truth, 2.0, static_cast<unsigned>(i))), truth));
  }
  EXPECT_LT(worst, 3.0) << "px at the frame's corners, after 16 frames";
}

TEST(CanvasMotionTest, StandsStillInSpiteOfNoise) {
  Follower follower;
  for (unsigned i = 0; i < 12; ++i) {
    const PlaneSimilarity found = follower.see(seen({}, 3.0, i));
    EXPECT_EQ(found.linear, glm::dvec2(1.0, 0.0)) << i;
    EXPECT_EQ(found.shift, glm::dvec2(0.0)) << i;
  }
}

TEST(CanvasMotionTest, FollowsASlowPanThatNoFrameShows) {
  Follower follower;
  PlaneSimilarity found;
  for (int i = 0; i <= 20; ++i) found = follower.see(seen({.shift = {0.2 * i, 0.0}}));
  EXPECT_NEAR(found.shift.x, 4.0, 0.5);
}

TEST(CanvasMotionTest, IsNotTakenAlongByAThing) {
  Follower follower;
  for (int i = 0; i < 15; ++i) {
    std::vector<std::uint8_t> luma = seen({});
    for (int y = 60; y < 180; ++y) {  // a quarter of the image, 8 px per frame
      for (int x = 0; x < 130; ++x) {
        const int column = x + 8 * i;
        luma[static_cast<std::size_t>(y * kSize.width + column)] =
            static_cast<std::uint8_t>(((x / 13) ^ (y / 11)) % 2 == 0 ? 40 : 210);
      }
    }
    EXPECT_LT(apart(follower.see(luma), {}), 3.0) << i;
  }
}

TEST(CanvasMotionTest, StaysWhereNothingCanBeFollowed) {
  Follower follower;
  follower.see(seen({}));
  const PlaneSimilarity before = follower.see(seen({.shift = {12.0, 0.0}}));
  EXPECT_NEAR(before.shift.x, 12.0, 0.7);
  const std::vector<std::uint8_t> blank(static_cast<std::size_t>(kSize.pixels()), 90);
  EXPECT_EQ(follower.see(blank).shift, before.shift);
  // A cut to another part of the wall.
  EXPECT_EQ(follower.see(seen({.shift = {5000.0, 900.0}})).shift, before.shift);
  // Motion continues from there.
  EXPECT_NEAR(follower.see(seen({.shift = {5006.0, 900.0}})).shift.x, before.shift.x + 6.0, 0.7);
  follower.reset();
  EXPECT_EQ(follower.see(seen({})).shift, glm::dvec2(0.0));
}

TEST(CanvasMotionTest, TakesPicturesOfAnySize) {
  Follower follower;
  for (const hal::FrameSize size : {hal::FrameSize{1, 1}, {3, 700}, {16, 16}, {1280, 720}}) {
    const std::vector<std::uint8_t> luma(static_cast<std::size_t>(size.pixels()), 77);
    for (int i = 0; i < 2; ++i) {
      const PlaneSimilarity found = follower.see(luma, size);
      EXPECT_EQ(found.shift, glm::dvec2(0.0));
    }
  }
}

}  // namespace
}  // namespace pleinair::tracking
