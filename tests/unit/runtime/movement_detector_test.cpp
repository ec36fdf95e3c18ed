#include "pipeline/runtime/capture/movement_detector.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace pleinair::runtime {
namespace {

using namespace std::chrono_literals;

/// A still scene before a noisy camera of 30 frames a second.
class MovementTest : public testing::Test {
 protected:
  static constexpr hal::FrameSize kSize{640, 480};

  /// The next frame: brighter by `light`, with a bright square of `side` px at (x, 200).
  bool look(double light = 0.0, int side = 0, int x = 0) {
    const std::size_t samples = hal::rowBytes(format_.pixelFormat, 0, kSize.width) / 640;
    for (int y = 0; y < kSize.height; ++y) {
      const auto row = image_.row(0, y);
      std::size_t at = random_() % kNoise;
      for (std::size_t i = 0; i < row.size(); ++i) {
        const int column = static_cast<int>(i / samples);
        const bool isInside = y >= 200 && y < 200 + side && column >= x && column < x + side;
        const double scene = scene_[static_cast<std::size_t>(y * kSize.width + column)];
        at = (at + 1) % kNoise;
        const double value = scene + light + (isInside ? 60.0 : 0.0) + noise_ * normal_[at];
        row[i] = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
      }
    }
    time_ += 33'333us;
    return detector_.look(image_.view(), time_);
  }
  /// How many of the next frames move.
  template <class Light>
  int movesIn(hal::Duration time, Light light) {
    int moves = 0;
    for (const hal::TimePoint end = time_ + time; time_ < end;) moves += look(light()) ? 1 : 0;
    return moves;
  }
  int movesIn(hal::Duration time) {
    return movesIn(time, [] { return 0.0; });
  }

  hal::FrameFormat format_{.pixelFormat = hal::PixelFormat::kGrey8, .size = kSize};
  hal::Image image_{format_};
  double noise_ = 5.0;
  hal::TimePoint time_{100s};
  std::minstd_rand random_{7};
  static constexpr std::size_t kNoise = 8191;
  std::vector<double> normal_ = [this] {
    std::vector<double> normal(kNoise);
    std::normal_distribution<double> draw;
    for (double& each : normal) each = draw(random_);
    return normal;
  }();
  std::vector<double> scene_ = [] {
    std::vector<double> scene;
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        scene.push_back(90.0 + 40.0 * std::sin(x * 0.05) * std::cos(y * 0.03));
      }
    }
    return scene;
  }();
  MovementDetector detector_;
};

TEST_F(MovementTest, NoiseAloneMovesNothing) {
  for (const double noise : {0.0, 5.0, 25.0}) {
    noise_ = noise;
    movesIn(2s);  // the change of noise itself
    EXPECT_EQ(movesIn(5s), 0) << noise;
  }
}

TEST_F(MovementTest, SomebodyWhoComesInIsSeenWithinASecond) {
  for (const double noise : {0.0, 5.0, 25.0}) {
    noise_ = noise;
    movesIn(3s);
    const hal::TimePoint began = time_;
    for (int x = 0; !look(0.0, 80, x) && time_ < began + 5s; x += 4) {
    }
    EXPECT_LE(time_ - began, 1s) << noise;
    movesIn(5s);
  }
}

TEST_F(MovementTest, WhatMovesSlowlyIsSeenToo) {
  movesIn(3s);
  int moves = 0;
  for (int i = 0; i < 150; ++i) moves += look(0.0, 100, i / 3) ? 1 : 0;  // 10 px a second
  EXPECT_GT(moves, 5);
}

TEST_F(MovementTest, AnExposureThatWandersIsNoMovement) {
  movesIn(1s);
  double light = 0.0;
  EXPECT_EQ(movesIn(5s, [&] { return light += 0.2; }), 0);
  EXPECT_EQ(movesIn(5s, [&] { return light - 20.0; }), 0) << "a lamp";
}

TEST_F(MovementTest, SomethingThatWasPutDownComesToRest) {
  movesIn(2s);
  int moves = 0;
  for (int i = 0; i < 300; ++i) moves += look(0.0, 60, 300) ? 1 : 0;
  EXPECT_GT(moves, 0);
  int later = 0;
  for (int i = 0; i < 150; ++i) later += look(0.0, 60, 300) ? 1 : 0;
  EXPECT_EQ(later, 0);
}

TEST_F(MovementTest, LooksFourTimesASecondInAnyFormat) {
  format_.pixelFormat = hal::PixelFormat::kRgb8;
  image_ = hal::Image(format_);
  EXPECT_FALSE(look()) << "the first frame of another format";
  movesIn(2s);
  int moves = 0;
  for (int i = 0; i < 30; ++i) moves += look(0.0, 100, 20 * i) ? 1 : 0;
  EXPECT_GE(moves, 2);
  EXPECT_LE(moves, 4);
}

TEST_F(MovementTest, ATinyFrameHasAGridToo) {
  hal::Image tiny({.pixelFormat = hal::PixelFormat::kGrey8, .size = {3, 2}});
  EXPECT_FALSE(detector_.look(tiny.view(), time_));
  for (int i = 0; i < 6; ++i) tiny.plane(0)[static_cast<std::size_t>(i)] = i < 3 ? 200 : 0;
  EXPECT_TRUE(detector_.look(tiny.view(), time_ + 1s));
}

}  // namespace
}  // namespace pleinair::runtime
