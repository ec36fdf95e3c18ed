#include "pipeline/measure/negative_controls.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/measure/gates.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/input/true_motion.h"
#include "pipeline/measure/sequence_measures.h"
#include "pipeline/styles/registry.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

using State = Verdict::State;
using testing::HasSubstr;

const cv::Size kSize(320, 240);
const cv::Point2d kPan(-1.5, -0.5);
const RunConditions kPanned{
    .motion = MotionKind::kPan, .frames = 14, .stillFrames = 4, .stillNoiseLevels = 2};

const styles::CoherenceGates& gatesOf(std::string_view style) {
  return styles::styleKind(style).coherence;
}

/// xEW2 of an input with detail that is displaced by 2 px.
constexpr std::optional<double> kDisplaced = 40.0;

/// Plausible measures of a pan over a canvas.
PerSubject<Measures> measuresOf(const cv::Mat3f& canvas, double noiseLevels = 2) {
  const auto motion = constantMotion(kSize, 2 * kPan);
  SequenceMeasures measures(kSize, motion.get());
  for (std::uint64_t i = 0; i < 14; ++i) {
    const cv::Point at(8 + static_cast<int>(3 * i), 8 + static_cast<int>(i));
    const cv::Mat3f frame =
        toFloat(withSensorNoise(windowOf(canvas, at, kSize), noiseLevels, i).view());
    EXPECT_TRUE(measures.add(i, frame, frame, {}));
  }
  return measures.totals();
}

TEST(Controls, ReadAsTheyMustOnAPictureWithDetail) {
  const PerSubject<Measures> measures = measuresOf(strongBlobs({400, 300}, 1));
  EXPECT_EQ(measures[Subject::kInput].xEw2, 1.0);
  EXPECT_NEAR(*measures[Subject::kInput].dep, 0.0, 1e-4);
  EXPECT_EQ(measures[Subject::kInput].det, 1.0);
  EXPECT_EQ(measures[Subject::kInput].s10Percent, 100.0);
  EXPECT_NEAR(*measures[Subject::kInput].ew2, 2 * (4 + 1.0 / 12) / 255 / 255 * 1000, 0.004);
  EXPECT_GT(*measures[Subject::kFresh].nHw2, 0.5);
  EXPECT_GT(*measures[Subject::kFixed].scr, 0.25);
  for (const std::string_view style : {"watercolor", "painterly", "none"}) {
    for (const Verdict& verdict : controlVerdicts(measures, gatesOf(style), kPanned, kDisplaced)) {
      EXPECT_EQ(verdict.state, State::kPassed) << style << ": " << verdict.what << verdict.found;
    }
  }
}

TEST(Controls, SayThatTheMotionIsAnother) {
  PerSubject<Measures> measures = measuresOf(strongBlobs({400, 300}, 1));
  measures[Subject::kInput].nHw2 = 0.87;
  const auto verdicts = controlVerdicts(measures, gatesOf("watercolor"), kPanned, kDisplaced);
  EXPECT_EQ(verdicts[0].state, State::kFailed);
  EXPECT_THAT(verdicts[0].found, HasSubstr("the motion is another"));
}

TEST(Controls, SayThatAPictureIsTooSmooth) {
  const cv::Mat3f flat(300, 400, cv::Vec3f(0.5F, 0.4F, 0.3F));
  const PerSubject<Measures> measures = measuresOf(flat, 0);
  const auto verdicts = controlVerdicts(measures, gatesOf("painterly"), kPanned, kDisplaced);
  bool isAnyWrong = false;
  for (const Verdict& verdict : verdicts) {
    if (verdict.state != State::kFailed) continue;
    isAnyWrong = true;
    EXPECT_THAT(verdict.found, HasSubstr("too smooth"));
  }
  EXPECT_TRUE(isAnyWrong);
}

TEST(Controls, SayWhatCouldNotBeTold) {
  PerSubject<Measures> measures;
  measures[Subject::kInput].ew2 = 0.0;
  for (const Verdict& verdict : controlVerdicts(measures, gatesOf("watercolor"), kPanned, {})) {
    EXPECT_EQ(verdict.state, State::kNotMeasured) << verdict.what;
    EXPECT_NE(verdict.found, "");
  }
}

Measures good() {
  return {.ew2 = 0.5,
          .xEw2 = 1,
          .nHw2 = 0.05,
          .popPercent = 0.5,
          .s10Percent = 95,
          .scr = 0.01,
          .xFlk = 0.1,
          .dep = 20,
          .det = 0.9};
}

std::vector<std::string> failed(std::string_view style, MotionKind kind, const Measures& measures) {
  std::vector<std::string> names;
  for (const Verdict& verdict :
       gateVerdicts(gatesOf(style), {.motion = kind}, measures, {.scr = 0.5, .dep = 20})) {
    if (verdict.state != State::kPassed) names.push_back(verdict.what.substr(0, 4));
  }
  return names;
}

TEST(Controls, MarksRedrawnEachFrameMustFailAGateOfCoherence) {
  PerSubject<Measures> measures;
  measures[Subject::kFixed] = {.scr = 0.5, .dep = 20};
  const auto freshReads = [&](const Measures& fresh) {
    measures[Subject::kFresh] = fresh;
    const auto verdicts = controlVerdicts(measures, gatesOf("painterly"), kPanned, kDisplaced);
    return std::ranges::find_if(
               verdicts, [](const Verdict& each) { return each.what.starts_with("marks redrawn"); })
        ->state;
  };
  Measures fresh = good();
  EXPECT_EQ(freshReads(fresh), State::kFailed);
  fresh.dep = 1;  // fails its gate, which is not about coherence
  fresh.det = 0.1;
  EXPECT_EQ(freshReads(fresh), State::kFailed);
  for (const auto& [measure, value] :
       {std::pair(&Measures::nHw2, 0.6), std::pair(&Measures::xFlk, 3.0),
        std::pair(&Measures::popPercent, 20.0)}) {
    Measures flickering = good();
    flickering.*measure = value;
    EXPECT_EQ(freshReads(flickering), State::kPassed);
  }
  fresh.nHw2.reset();
  fresh.xFlk.reset();
  fresh.popPercent.reset();
  EXPECT_EQ(freshReads(fresh), State::kNotMeasured);
}

TEST(Controls, EachCanFail) {
  PerSubject<Measures> measures;
  measures[Subject::kInput] = {.nHw2 = 0.9};
  measures[Subject::kFresh] = good();
  measures[Subject::kFixed] = {.scr = 0.01, .dep = 20};
  for (const Verdict& verdict : controlVerdicts(measures, gatesOf("painterly"), kPanned, 1.9)) {
    EXPECT_EQ(verdict.state, State::kFailed) << verdict.what;
  }
}

/// EW2 of the input over itself is 1 and could not fail; displaced by 2 px, it can.
TEST(Controls, TellADisplacementOfTwoPixels) {
  const auto displacedOf = [](cv::Point2d perFrame, const cv::Mat3f& canvas) {
    const auto motion = constantMotion(kSize, perFrame);
    SequenceMeasures measures(kSize, motion.get());
    for (std::uint64_t i = 0; i < 6; ++i) {
      const cv::Point at(8 + 3 * static_cast<int>(i), 8 + static_cast<int>(i));
      const cv::Mat3f frame = toFloat(withSensorNoise(windowOf(canvas, at, kSize), 2, i).view());
      EXPECT_TRUE(measures.add(i, frame, frame, {}));
    }
    return *measures.displacedXEw2();
  };
  const cv::Mat3f blobs = strongBlobs({400, 300}, 1);
  EXPECT_GT(displacedOf({-3, -1}, blobs), 10.0);
  EXPECT_LT(displacedOf({-4, -1}, blobs), 1.0) << "a motion that is 2 px off in two frames";
  EXPECT_NEAR(displacedOf({-3, -1}, cv::Mat3f(300, 400, cv::Vec3f(0.5F, 0.4F, 0.3F))), 1.0, 0.05);
}

TEST(Gates, PassWhatIsWithinAndStopTheRest) {
  using testing::ElementsAre;
  using testing::IsEmpty;
  EXPECT_THAT(failed("painterly", MotionKind::kPan, good()), IsEmpty());
  EXPECT_THAT(failed("watercolor", MotionKind::kPan, good()), IsEmpty());
  Measures bad = good();
  bad.ew2 = 0.61;
  bad.popPercent = 1.1;
  EXPECT_THAT(failed("painterly", MotionKind::kPan, bad), ElementsAre("EW2 ", "POP "));
  EXPECT_THAT(failed("painterly", MotionKind::kOther, bad), ElementsAre("EW2 "));
  EXPECT_THAT(failed("watercolor", MotionKind::kPan, bad), IsEmpty());
  bad = good();
  bad.popPercent = 1.6;
  EXPECT_THAT(failed("painterly", MotionKind::kOther, bad), ElementsAre("POP "));
  bad = good();
  bad.nHw2 = 0.15;
  bad.s10Percent = 85;
  EXPECT_THAT(failed("painterly", MotionKind::kPan, bad), ElementsAre("nHW2", "S10 "));
  EXPECT_THAT(failed("painterly", MotionKind::kOther, bad), IsEmpty());
  bad = good();
  bad.scr = 0.16;
  bad.xFlk = 0.16;
  bad.dep = 14.9;
  EXPECT_THAT(failed("watercolor", MotionKind::kPan, bad), ElementsAre("xFLK", "DEP ", "SCR "));
  EXPECT_THAT(failed("painterly", MotionKind::kPan, bad), ElementsAre("DEP "));
}

TEST(Gates, AreNotPassedByWhatWasNotMeasured) {
  Measures measures = good();
  measures.scr.reset();
  EXPECT_THAT(failed("watercolor", MotionKind::kStill, measures), testing::IsEmpty())
      << "nothing can stay on the screen while nothing moves";
  EXPECT_THAT(failed("watercolor", MotionKind::kPan, measures), testing::ElementsAre("SCR "));
}

TEST(Gates, SayWhyOneWasNotMeasuredAndCompareNumbers) {
  Measures measures = good();
  measures.s10Percent.reset();
  const RunConditions few{.motion = MotionKind::kPan, .frames = 4};
  const auto verdicts = gateVerdicts(gatesOf("painterly"), few, measures, {.dep = 20});
  const auto lasting = std::ranges::find_if(
      verdicts, [](const Verdict& each) { return each.what.starts_with("S10"); });
  ASSERT_NE(lasting, verdicts.end());
  EXPECT_EQ(lasting->found, "it compares frames 10 apart, and there are 4");
  ASSERT_TRUE(lasting->comparison);
  EXPECT_FALSE(lasting->comparison->value);
  EXPECT_EQ(lasting->comparison->limit, 90);
  EXPECT_FALSE(lasting->comparison->isUpperLimit);
  const auto deviation = std::ranges::find_if(
      verdicts, [](const Verdict& each) { return each.what.starts_with("DEP"); });
  ASSERT_TRUE(deviation != verdicts.end() && deviation->comparison);
  EXPECT_EQ(deviation->comparison->limit, 15);
  EXPECT_EQ(deviation->comparison->value, 20);
}

TEST(RunConditions, SayWhyAMeasureIsMissing) {
  Measures none;
  EXPECT_THAT(missingLines(none, {.motion = MotionKind::kNone, .frames = 20}),
              testing::ElementsAre(HasSubstr("EW2, xEW2, nHW2, POP %, S10 %: it needs the true"),
                                   HasSubstr("SCR: too little"), HasSubstr("xFLK: no still"),
                                   HasSubstr("DEP, DET: the input has no detail")));
  EXPECT_THAT(reasonMissing(&Measures::xFlk, {.stillFrames = 4}), HasSubstr("--noise 0"));
  EXPECT_THAT(missingLines(good(), {}), testing::IsEmpty());
}

TEST(Gates, OfAnchorsAreThePainterlyOnes) {
  AnchorSummary quiet{.frames = 10};
  AnchorSummary busy{.frames = 10, .births = 1, .innerTurnoverPercent = 0.6};
  EXPECT_TRUE(anchorVerdicts(gatesOf("watercolor"), MotionKind::kPan, quiet, quiet).empty());
  for (const Verdict& verdict :
       anchorVerdicts(gatesOf("painterly"), MotionKind::kPan, quiet, quiet)) {
    EXPECT_EQ(verdict.state, State::kPassed);
  }
  for (const Verdict& verdict :
       anchorVerdicts(gatesOf("painterly"), MotionKind::kPan, busy, busy)) {
    EXPECT_EQ(verdict.state, State::kFailed);
  }
  for (const Verdict& verdict : anchorVerdicts(gatesOf("painterly"), MotionKind::kPan, {}, {})) {
    EXPECT_EQ(verdict.state, State::kNotMeasured);
  }
  EXPECT_EQ(anchorVerdicts(gatesOf("painterly"), MotionKind::kOther, busy, quiet).size(), 1u);
}

TEST(VoronoiTiling, GivesEachTileTheMeanOfWhatItCovers) {
  const cv::Mat3f picture = noisePicture(kSize, 0.1, 4);
  const cv::Mat3f painted = VoronoiTiling(kSize, 5).paint(picture);
  const cv::Scalar before = cv::mean(picture);
  const cv::Scalar after = cv::mean(painted);
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(before[c], after[c], 1e-5);
  // A tile has 64 px on average, so its mean has an eighth of the noise; larger tiles have less.
  cv::Scalar mean, deviation;
  cv::meanStdDev(painted, mean, deviation);
  EXPECT_NEAR(deviation[0], 0.1 / 8, 0.003);
}

TEST(VoronoiTiling, IsTheSameOfOneSeedAndAnotherOfAnother) {
  const cv::Mat3f picture = blobPicture(kSize, 6);
  const cv::Mat3f painted = VoronoiTiling(kSize, 7).paint(picture);
  EXPECT_EQ(cv::norm(painted, VoronoiTiling(kSize, 7).paint(picture), cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(painted, VoronoiTiling(kSize, 8).paint(picture), cv::NORM_INF), 0.05);
}

}  // namespace
}  // namespace pleinair::measure
