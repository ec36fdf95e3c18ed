// Measures of movers, on paintings that are made so that each value is known.
#include "pipeline/measure/mover_measures.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <random>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

namespace pleinair::measure {
namespace {

constexpr hal::FrameSize kSize{240, 180};
constexpr int kFrames = 90;
constexpr int kFramesPerSecond = 30;
constexpr int kWidth = 30;  // px of the mover
constexpr int kSpeed = 6;   // px a frame
constexpr int kComes = 10;  // first frame with it

hal::TimePoint timeOf(int frame) {
  return hal::TimePoint(std::chrono::milliseconds(1000 * frame / kFramesPerSecond));
}

/// A grey wall with little noise, before which a red bar passes once.
cv::Mat3b seen(int frame) {
  cv::Mat3b picture(kSize.height, kSize.width);
  std::mt19937 random(static_cast<unsigned>(frame));
  for (cv::Vec3b& each : picture) {
    const auto grey = static_cast<std::uint8_t>(120 + random() % 3U);
    each = {grey, grey, grey};
  }
  const int left = (frame - kComes) * kSpeed;
  cv::rectangle(picture, {left, 50}, {left + kWidth, 130}, {200, 30, 20}, cv::FILLED);
  return picture;
}

hal::Image imageOf(const cv::Mat3b& picture) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kSize});
  for (int y = 0; y < picture.rows; ++y) {
    std::copy_n(picture.ptr<std::uint8_t>(y), static_cast<std::size_t>(picture.cols) * 3,
                image.row(0, y).data());
  }
  return image;
}

MoverReport reportOf(const std::function<cv::Mat3b(int)>& paint) {
  MoverMeasures measures;
  for (int i = 0; i < kFrames; ++i) {
    measures.add(timeOf(i), imageOf(seen(i)), imageOf(paint(i)));
  }
  return measures.total().value();
}

TEST(MoverMeasures, APaintingLikeTheInputPasses) {
  const MoverReport report = reportOf(seen);
  EXPECT_NEAR(report.painting.coveredPercent, 5.0, 1.0);
  EXPECT_NEAR(report.painting.stillPercent.value(), 0.0, 0.01);
  EXPECT_LT(report.painting.returnLevels.value(), 2.0);
  EXPECT_LT(report.painting.ghost.value(), 0.05);
  EXPECT_NEAR(report.painting.lostPercent.value(), 0.0, 0.5);
  for (const Verdict& verdict : moverVerdicts(report.painting, false)) {
    EXPECT_EQ(verdict.state, Verdict::State::kPassed) << verdict.what;
  }
}

TEST(MoverMeasures, APainterThatNeverPaintsMoversLosesThem) {
  const cv::Mat3b wall = seen(0);
  const MoverReport report = reportOf([&](int) { return wall; });
  EXPECT_GT(report.painting.lostPercent.value(), 99.0);
  EXPECT_LT(report.painting.ghost.value(), 0.05);
}

TEST(MoverMeasures, ATrailIsAGhost) {
  // The painting is the mean of the input and of the input ten frames ago.
  const MoverReport report = reportOf([](int frame) {
    cv::Mat3b painted;
    cv::addWeighted(seen(frame), 0.5, seen(std::max(frame - 10, 0)), 0.5, 0.0, painted);
    return painted;
  });
  EXPECT_GT(report.painting.ghost.value(), 0.4);
  EXPECT_LT(report.painting.returnLevels.value(), 2.0) << "it has gone after a second";
}

TEST(MoverMeasures, APlaceThatIsPaintedAnewHasNotReturned) {
  const MoverReport report = reportOf([](int frame) {
    cv::Mat3b painted = seen(frame);
    const int left = (frame - kComes) * kSpeed;
    // Everything that the bar has passed becomes ten levels lighter.
    if (left > 0) {
      painted(cv::Rect(0, 0, std::min(left, kSize.width), kSize.height)) += cv::Scalar(10, 10, 10);
    }
    return painted;
  });
  EXPECT_NEAR(report.painting.returnLevels.value(), 10.0, 2.0);
}

TEST(MoverMeasures, AChangeAwayFromMoversIsNotStill) {
  const MoverReport report = reportOf([](int frame) {
    cv::Mat3b painted = seen(frame);
    painted(cv::Rect(60, 135, 20, 5)) += cv::Scalar::all(frame % 2 == 0 ? 30 : 0);
    return painted;
  });
  // The border leaves 160x100 px, of which 100 change.
  EXPECT_NEAR(report.painting.stillPercent.value(), 0.6, 0.2);
}

TEST(MoverMeasures, ControlsThatMustFailDo) {
  const MoverReport report = reportOf(seen);
  for (const Verdict& verdict : moverControlVerdicts(report)) {
    EXPECT_EQ(verdict.state, Verdict::State::kPassed) << verdict.what << ": " << verdict.found;
  }
}

TEST(MoverMeasures, WithoutAMoverNothingIsMeasured) {
  MoverMeasures measures;
  measures.add(timeOf(0), imageOf(seen(0)), imageOf(seen(0)));
  EXPECT_FALSE(measures.total()) << "one frame";
  for (int i = 1; i < 5; ++i) measures.add(timeOf(i), imageOf(seen(0)), imageOf(seen(0)));
  const MoverReport report = measures.total().value();
  EXPECT_FALSE(report.painting.ghost);
  EXPECT_FALSE(report.painting.returnLevels);
  EXPECT_FALSE(report.painting.lostPercent);
  for (const Verdict& verdict : moverVerdicts(report.painting, true)) {
    EXPECT_THAT(verdict.what, testing::Not(testing::HasSubstr("LOST"))) << "on paper";
    const bool isStill = verdict.what.starts_with("STILL");
    EXPECT_EQ(verdict.state, isStill ? Verdict::State::kPassed : Verdict::State::kNotMeasured);
    EXPECT_EQ(verdict.found == "no mover came and went", !isStill) << verdict.what;
  }
}

TEST(MoverMeasures, WhatIsMissingSaysWhy) {
  for (const Verdict& verdict : moverVerdicts({}, false)) {
    EXPECT_EQ(verdict.state, Verdict::State::kNotMeasured);
    const bool needsVisit = verdict.what.starts_with("RETURN") || verdict.what.starts_with("GHOST");
    EXPECT_EQ(verdict.found == "no mover came and went", needsVisit) << verdict.what;
  }
}

}  // namespace
}  // namespace pleinair::measure
