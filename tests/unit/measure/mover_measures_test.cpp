// Measures of movers, on paintings that are made so that each value is known.
#include "pipeline/measure/mover_measures.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <random>

#include <gmock/gmock.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/mover_gates.h"

namespace pleinair::measure {
namespace {

constexpr hal::FrameSize kSize{240, 180};
constexpr int kFrames = 72;
constexpr int kFramesPerSecond = 30;
constexpr int kWidth = 48;  // px of the mover
constexpr int kSpeed = 12;  // px a frame
constexpr int kComes = 10;  // first frame with it

hal::TimePoint timeOf(int frame) {
  return hal::TimePoint(std::chrono::milliseconds(1000 * frame / kFramesPerSecond));
}

cv::Rect barOf(int frame) {
  return cv::Rect((frame - kComes) * kSpeed, 50, kWidth, 80) &
         cv::Rect(0, 0, kSize.width, kSize.height);
}

/// A grey wall with little noise, before which a red bar passes once.
cv::Mat3b seen(int frame) {
  cv::Mat3b picture(kSize.height, kSize.width);
  std::mt19937 random(static_cast<unsigned>(frame));
  for (cv::Vec3b& each : picture) {
    const auto grey = static_cast<std::uint8_t>(120 + random() % 3U);
    each = {grey, grey, grey};
  }
  if (const cv::Rect bar = barOf(frame); !bar.empty()) picture(bar).setTo(cv::Scalar(200, 30, 20));
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
    measures.add({.time = timeOf(i), .input = imageOf(seen(i)), .output = imageOf(paint(i))});
  }
  return measures.total().value();
}

/// Marks of 4 px on the bar that go with it, or else stay on the screen.
cv::Mat3b marked(int frame, bool areCarried) {
  cv::Mat3b painted = seen(frame);
  const cv::Rect bar = barOf(frame);
  const int origin = areCarried ? (frame - kComes) * kSpeed : 0;
  for (int y = bar.y; y < bar.br().y; ++y) {
    for (int x = bar.x; x < bar.br().x; ++x) {
      const auto cell = static_cast<unsigned>((x - origin + 400) / 4 * 7919 + y / 4 * 104729);
      const auto level = static_cast<std::uint8_t>((cell * 2654435761U) >> 25U);
      painted(y, x) = {static_cast<std::uint8_t>(100 + level), level, 20};
    }
  }
  return painted;
}

cv::Mat1b maskOf(int frame) {
  cv::Mat1b mask(kSize.height, kSize.width, static_cast<std::uint8_t>(0));
  if (const cv::Rect bar = barOf(frame); !bar.empty()) mask(bar).setTo(255);
  return mask;
}

/// From the frame two before: the wall stands, and hides nothing that the bar uncovers.
MotionMap motionTo(int frame) {
  cv::Mat2f displacement(kSize.height, kSize.width, cv::Vec2f());
  cv::Mat1b isSeen;
  cv::bitwise_or(maskOf(frame), maskOf(frame - 2), isSeen);
  cv::bitwise_not(isSeen, isSeen);
  const cv::Rect bar = barOf(frame - 2);
  if (!bar.empty()) {
    displacement(bar).setTo(cv::Scalar(2 * kSpeed, 0));
    isSeen(bar).setTo(255);
  }
  return fieldMap(displacement, isSeen, 0.15F);
}

/// The input shows what is painted; its movers and their motion are known.
MoverReport truthReportOf(const std::function<cv::Mat3b(int)>& see,
                          const std::function<cv::Mat3b(int)>& paint) {
  MoverMeasures measures;
  for (int i = 0; i < kFrames; ++i) {
    const MotionMap motion = motionTo(i);
    measures.add({.time = timeOf(i),
                  .input = imageOf(see(i)),
                  .output = imageOf(paint(i)),
                  .trueMovers = maskOf(i),
                  .trueMotion = i < 2 ? nullptr : &motion});
  }
  return measures.total().value();
}

MoverReport truthReportOf(const std::function<cv::Mat3b(int)>& paint) {
  return truthReportOf([](int frame) { return marked(frame, true); }, paint);
}

TEST(MoverMeasures, MarksThatAMoverCarriesPass) {
  const MoverReport report = truthReportOf([](int frame) { return marked(frame, true); });
  EXPECT_TRUE(report.areMasksTrue);
  const MoverMotionSummary& along = report.alongMotion[Subject::kPainting];
  EXPECT_LT(along.nHw2.value(), 0.1);
  EXPECT_LT(along.popPercent.value(), 0.1);
  EXPECT_LT(along.seamPopPercent.value(), 0.1);
  EXPECT_NEAR(report.painting.lostPercent.value(), 0.0, 0.5);
  for (const Verdict& verdict : moverVerdicts(report, {})) {
    EXPECT_EQ(verdict.state, Verdict::State::kPassed) << verdict.what << ": " << verdict.found;
  }
  for (const Verdict& verdict : moverControlVerdicts(report, {})) {
    EXPECT_EQ(verdict.state, Verdict::State::kPassed) << verdict.what << ": " << verdict.found;
  }
}

TEST(MoverMeasures, MarksThatAMoverSlidesUnderFail) {
  const MoverReport report = truthReportOf([](int frame) { return marked(frame, false); });
  const MoverMotionSummary& along = report.alongMotion[Subject::kPainting];
  EXPECT_GT(along.nHw2.value(), 0.5);
  EXPECT_GT(along.popPercent.value(), 20.0);
  EXPECT_GT(along.smoothPopPercent.value(), 10.0);
  EXPECT_LT(report.alongMotion[Subject::kInput].nHw2.value(), 0.1);
  int failed = 0;
  for (const Verdict& verdict : moverVerdicts(report, {})) {
    const bool isAlong = verdict.what.starts_with("MOVER") || verdict.what.starts_with("SEAM");
    EXPECT_EQ(verdict.state, isAlong ? Verdict::State::kFailed : Verdict::State::kPassed)
        << verdict.what << ": " << verdict.found;
    failed += isAlong ? 1 : 0;
  }
  EXPECT_EQ(failed, 3);
}

TEST(MoverMeasures, ARimThatFlickersBesideAMoverIsInTheSeamOnly) {
  const MoverReport report = truthReportOf([](int frame) {
    cv::Mat3b painted = marked(frame, true);
    // It is 4 px to 8 px above the bar, and lighter in two frames of four.
    const cv::Rect bar = barOf(frame);
    if (!bar.empty() && frame % 4 < 2) {
      painted(cv::Rect(bar.x, bar.y - 8, bar.width, 4)) += cv::Scalar::all(40);
    }
    return painted;
  });
  const MoverMotionSummary& along = report.alongMotion[Subject::kPainting];
  EXPECT_LT(along.popPercent.value(), 0.1);
  EXPECT_GT(along.seamPopPercent.value(), 3.0);
  EXPECT_LT(report.alongMotion[Subject::kInput].seamPopPercent.value(), 0.1);
}

TEST(MoverMeasures, WithoutTruthMotionIsEstimated) {
  MoverMeasures measures;
  for (int i = 0; i < kFrames; ++i) {
    const hal::Image input = imageOf(marked(i, true));
    measures.add({.time = timeOf(i), .input = input, .output = input});
  }
  const MoverReport report = measures.total().value();
  EXPECT_FALSE(report.areMasksTrue);
  EXPECT_LT(report.alongMotion[Subject::kPainting].popPercent.value(), 2.0);
  EXPECT_LT(report.alongMotion[Subject::kPainting].seamPopPercent.value(), 3.0);
}

TEST(MoverMeasures, APaintingLikeTheInputPasses) {
  const MoverReport report = reportOf(seen);
  EXPECT_NEAR(report.painting.coveredPercent, 5.0, 1.5);
  EXPECT_NEAR(report.painting.stillPercent.value(), 0.0, 0.01);
  EXPECT_LT(report.painting.returnLevels.value(), 2.0);
  EXPECT_LT(report.painting.ghost.value(), 0.05);
  EXPECT_NEAR(report.painting.lostPercent.value(), 0.0, 0.5);
  for (const Verdict& verdict : moverVerdicts(report, {})) {
    EXPECT_NE(verdict.state, Verdict::State::kFailed) << verdict.what << ": " << verdict.found;
  }
}

TEST(MoverMeasures, APainterThatNeverPaintsMoversLosesThem) {
  const cv::Mat3b wall = seen(0);
  const MoverReport report = reportOf([&](int) { return wall; });
  EXPECT_GT(report.painting.lostPercent.value(), 99.0);
  EXPECT_LT(report.painting.ghost.value(), 0.05);
}

/// A dark bar before a wall that goes from dark to light, and paintings in a light palette: what is
/// nearest to the painted bar is the wall.
TEST(MoverMeasures, AMoverInALightPaletteIsNotLost) {
  const auto before = [](int frame, std::uint8_t bar) {
    cv::Mat3b picture = seen(frame);
    for (int y = 0; y < picture.rows; ++y) {
      for (int x = 0; x < picture.cols; ++x) {
        picture(y, x) = cv::Vec3b::all(cv::saturate_cast<std::uint8_t>(60 + y));
      }
    }
    if (const cv::Rect place = barOf(frame); !place.empty()) {
      picture(place).setTo(cv::Scalar::all(bar));
    }
    return picture;
  };
  const auto lostOf = [&](std::uint8_t painted) {
    MoverMeasures measures;
    for (int i = 0; i < kFrames; ++i) {
      cv::Mat3b light;
      before(i, painted).convertTo(light, -1, 0.4, 130.0);
      measures.add({.time = timeOf(i), .input = imageOf(before(i, 5)), .output = imageOf(light)});
    }
    return measures.total().value().painting.lostPercent.value();
  };
  EXPECT_LT(lostOf(5), 0.5);
  EXPECT_GT(lostOf(150), 99.0) << "the control: a bar that is painted as the wall is";
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

/// The sequence begins while the bar is in view; the painting keeps half of what it showed first.
TEST(MoverMeasures, WhatIsLeftOfAMoverOfTheFirstFrameRemains) {
  constexpr int kFirst = kComes + 8;
  const auto remainsOf = [](const std::function<cv::Mat3b(int)>& paint) {
    MoverMeasures measures;
    for (int i = kFirst; i < kFrames; ++i) {
      measures.add({.time = timeOf(i), .input = imageOf(seen(i)), .output = imageOf(paint(i))});
    }
    return measures.total().value().painting.remainsPercent;
  };
  const cv::Rect first = barOf(kFirst);
  const double remains = remainsOf([&](int frame) {
                           cv::Mat3b painted = seen(frame);
                           const cv::Rect half(first.x, first.y, first.width, first.height / 2);
                           painted(half).setTo(cv::Scalar(200, 30, 20));
                           return painted;
                         }).value();
  EXPECT_NEAR(remains, 50.0, 8.0);
  EXPECT_LT(remainsOf(seen).value(), 0.1);
  EXPECT_FALSE(reportOf(seen).painting.remainsPercent) << "no mover is there at first";
}

/// Lines on bare paper are nearer to what they were than to any camera's picture.
TEST(MoverMeasures, RemainsAreNotJudgedOnPaper) {
  MoverReport report;
  report.painting.remainsPercent = 50.0;
  const auto failed = [&](MoverMarks marks) {
    return std::ranges::count_if(moverVerdicts(report, marks), [](const Verdict& verdict) {
      return verdict.state == Verdict::State::kFailed;
    });
  };
  EXPECT_EQ(failed({}), 1);
  EXPECT_EQ(failed({.areOnPaper = true}), 0);
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

/// A painting need not show the camera's noise: what changes elsewhere is not made good by it.
TEST(MoverMeasures, NoiseOfTheInputHidesNoChange) {
  const auto stillOf = [](int flicker) {
    MoverMeasures measures;
    std::mt19937 random(7);
    for (int i = 0; i < kFrames; ++i) {
      cv::Mat3b noisy = seen(i);
      for (cv::Vec3b& each : noisy) {
        if (random() % 50U == 0U) each += cv::Vec3b(0, 12, 0);
      }
      cv::Mat3b painted = seen(i);
      painted(cv::Rect(60, 135, 20, 5)) += cv::Scalar::all(i % 2 == 0 ? flicker : 0);
      measures.add({.time = timeOf(i), .input = imageOf(noisy), .output = imageOf(painted)});
    }
    return measures.total().value().painting.stillPercent.value();
  };
  EXPECT_NEAR(stillOf(30), 0.6, 0.2);
  EXPECT_LT(stillOf(0), 0.01);
}

/// Nothing moves; a lamp lights half of the wall from frame kSwitched on.
class MoverMeasuresLamp : public testing::Test {
 protected:
  static constexpr int kSwitched = 20;

  static cv::Mat3b lit(int frame, double share) {
    cv::Mat3b picture = seen(0);
    cv::Mat3b half = picture(cv::Rect(0, 0, kSize.width / 2, kSize.height));
    if (frame >= kSwitched) half += cv::Scalar::all(80.0 * share);
    return picture;
  }
  static MoverReport reportOf(const std::function<cv::Mat3b(int)>& paint) {
    const cv::Mat1b nobody(kSize.height, kSize.width, static_cast<std::uint8_t>(0));
    MoverMeasures measures;
    for (int i = 0; i < kFrames; ++i) {
      measures.add({.time = timeOf(i),
                    .input = imageOf(lit(i, 1.0)),
                    .output = imageOf(paint(i)),
                    .trueMovers = nobody});
    }
    return measures.total().value();
  }
};

TEST_F(MoverMeasuresLamp, APaintingFollowsIt) {
  const MoverReport report = reportOf([](int frame) { return lit(frame, 1.0); });
  EXPECT_NEAR(report.painting.follow.value(), 0.0, 0.01);
  EXPECT_EQ(report.painting.stillPercent.value(), 0.0);
  for (const Verdict& verdict : moverVerdicts(report, {})) {
    EXPECT_NE(verdict.state, Verdict::State::kFailed) << verdict.what << ": " << verdict.found;
  }
  int controls = 0;
  for (const Verdict& verdict : moverControlVerdicts(report, {})) {
    EXPECT_NE(verdict.state, Verdict::State::kFailed) << verdict.what << ": " << verdict.found;
    controls += verdict.what.starts_with("FOLLOW") ? 1 : 0;
  }
  EXPECT_EQ(controls, 1);
}

TEST_F(MoverMeasuresLamp, APaintingThatComesHalfWayIn300MsDoesNot) {
  const MoverReport report = reportOf(
      [](int frame) { return lit(frame, std::clamp((frame - kSwitched) / 18.0, 0.0, 1.0)); });
  EXPECT_NEAR(report.painting.follow.value(), 0.5, 0.02);
  EXPECT_EQ(report.painting.stillPercent.value(), 0.0) << "within a second";
}

TEST_F(MoverMeasuresLamp, APaintingThatNeverChangesFollowsNothing) {
  const MoverReport report = reportOf([](int) { return lit(0, 1.0); });
  EXPECT_EQ(report.painting.follow.value(), 1.0);
}

TEST_F(MoverMeasuresLamp, WhatChangesASecondLaterDoesNotStandStill) {
  const auto stillOf = [](int frames) {
    const auto paint = [frames](int frame) {
      return lit(frame, frame < kSwitched + frames ? 1.0 : 0.5);
    };
    return reportOf(paint).painting.stillPercent.value();
  };
  EXPECT_EQ(stillOf(20), 0.0);
  EXPECT_GT(stillOf(40), 0.5);
}

TEST(MoverMeasures, ControlsThatMustFailDo) {
  const MoverReport report = reportOf(seen);
  for (const Verdict& verdict : moverControlVerdicts(report, {})) {
    EXPECT_NE(verdict.state, Verdict::State::kFailed) << verdict.what << ": " << verdict.found;
  }
}

TEST(MoverMeasures, WithoutAMoverNothingIsMeasured) {
  MoverMeasures measures;
  const hal::Image empty = imageOf(seen(0));
  measures.add({.time = timeOf(0), .input = empty, .output = empty});
  EXPECT_FALSE(measures.total()) << "one frame";
  for (int i = 1; i < 5; ++i) {
    measures.add({.time = timeOf(i), .input = empty, .output = empty});
  }
  const MoverReport report = measures.total().value();
  EXPECT_FALSE(report.painting.ghost);
  EXPECT_FALSE(report.painting.returnLevels);
  EXPECT_FALSE(report.painting.lostPercent);
  for (const Verdict& verdict : moverControlVerdicts(report, {})) {
    EXPECT_EQ(verdict.state, Verdict::State::kNotMeasured) << verdict.what;
  }
  for (const Verdict& verdict : moverVerdicts(report, {.areOnPaper = true})) {
    EXPECT_THAT(verdict.what, testing::Not(testing::HasSubstr("LOST"))) << "on paper";
    const bool isStill = verdict.what.starts_with("STILL");
    EXPECT_EQ(verdict.state, isStill ? Verdict::State::kPassed : Verdict::State::kNotMeasured);
    EXPECT_EQ(verdict.found == "no mover came and went",
              verdict.what.starts_with("RETURN") || verdict.what.starts_with("GHOST"));
  }
}

/// An estimated motion that does not explain the input says nothing about marks.
TEST(MoverMeasures, AlongAWrongMotionNothingIsJudged) {
  MoverReport report;
  report.alongMotion[Subject::kPainting] = {.nHw2 = 0.1, .popPercent = 90.0, .seamPopPercent = 1.0};
  report.alongMotion[Subject::kInput] = {.nHw2 = 0.1, .popPercent = 92.0, .seamPopPercent = 1.4};
  const auto stateOf = [&](std::string_view name) {
    for (const Verdict& verdict : moverVerdicts(report, {.areOnPaper = true})) {
      if (verdict.what.starts_with(name)) return verdict.state;
    }
    return Verdict::State::kNotMeasured;
  };
  EXPECT_EQ(stateOf("MOVER POP"), Verdict::State::kNotMeasured);
  EXPECT_EQ(stateOf("MOVER nHW2"), Verdict::State::kPassed);
  EXPECT_EQ(stateOf("SEAM POP"), Verdict::State::kPassed);
  report.alongMotion[Subject::kInput].popPercent = 0.9;
  EXPECT_EQ(stateOf("MOVER POP"), Verdict::State::kFailed) << "the control";
}

/// Lines of a pixel, half of a pixel off: each changes clearly, their drawing does not.
TEST(MoverMeasures, LinesAreComparedSmoothed) {
  MoverReport report;
  report.alongMotion[Subject::kPainting] = {.nHw2 = 0.1,
                                            .popPercent = 35.0,
                                            .seamPopPercent = 35.0,
                                            .smoothPopPercent = 5.0,
                                            .smoothSeamPopPercent = 8.0};
  report.alongMotion[Subject::kInput] = {.nHw2 = 0.1,
                                         .popPercent = 0.1,
                                         .seamPopPercent = 0.1,
                                         .smoothPopPercent = 0.1,
                                         .smoothSeamPopPercent = 0.1};
  const auto failures = [&](bool areLines) {
    std::vector<std::string> failed;
    for (const Verdict& verdict : moverVerdicts(report, {.areLines = areLines})) {
      if (verdict.state == Verdict::State::kFailed) failed.push_back(verdict.what);
    }
    return failed;
  };
  EXPECT_THAT(failures(false), testing::SizeIs(2));
  EXPECT_THAT(failures(true), testing::IsEmpty());
  report.alongMotion[Subject::kPainting].smoothPopPercent = 40.0;
  EXPECT_THAT(failures(true), testing::ElementsAre(testing::StartsWith("smoothed MOVER POP")));
}

TEST(MoverMeasures, WhatIsMissingSaysWhy) {
  for (const Verdict& verdict : moverVerdicts({}, {})) {
    EXPECT_EQ(verdict.state, Verdict::State::kNotMeasured);
    const bool needsVisit = verdict.what.starts_with("RETURN") || verdict.what.starts_with("GHOST");
    EXPECT_EQ(verdict.found == "no mover came and went", needsVisit) << verdict.what;
  }
}

}  // namespace
}  // namespace pleinair::measure
