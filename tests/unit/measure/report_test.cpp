#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pipeline/measure/measurement_report.h"

namespace pleinair::measure {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

Report report() {
  Report report{.style = "water<color>",
                .settings = "look default",
                .input = "in & out",
                .motion = "pan",
                .motionKind = MotionKind::kPan,
                .size = {320, 240},
                .frames = 2};
  report.measures[Subject::kPainting] = {.ew2 = 0.25, .nHw2 = 0.0625};
  report.controls = {{"input", Verdict::State::kPassed, "1"}};
  report.gates = {
      {"nHW2 ≤ 0.3", Verdict::State::kPassed, "0.062",
       Verdict::Comparison{.value = 0.0625, .limit = 0.3}},
      {"S10 % ≥ 90", Verdict::State::kNotMeasured, "it compares frames 10 apart, and there are 3",
       Verdict::Comparison{.value = {}, .limit = 90, .isUpperLimit = false}}};
  report.inside = AnchorSummary{.frames = 3, .alive = 100, .drift = Drift{.median = 0.5}};
  for (std::uint64_t i = 0; i < 3; ++i) {
    FrameValues values{.frame = i};
    values.painting.ew2 = 0.1 * static_cast<double>(i);
    report.overTime.push_back(values);
  }
  const hal::FrameFormat format{
      .pixelFormat = hal::PixelFormat::kRgb8, .size = {8, 8}, .encoding = {}};
  report.worst.push_back({.frame = 2,
                          .ew2 = 0.2,
                          .input = hal::Image(format),
                          .output = hal::Image(format),
                          .difference = hal::Image(format)});
  return report;
}

TEST(Report, HasATableOfEachRegionWithModels) {
  Report with = report();
  EXPECT_TRUE(nlohmann::json::parse(reportJson(with))["models"].is_null());
  EXPECT_THAT(reportHtml(with), Not(HasSubstr("Models")));
  with.models = ModelReport{
      .forgettingRatio = 7.5,
      .anchors = ModelAnchorSummary{.frames = 4,
                                    .anchors = 80,
                                    .births = 0.5,
                                    .deaths = 0.3,
                                    .turnoverPercent = 1,
                                    .slip = Drift{.median = 0.001, .percentile95 = 0.02}}};
  with.models->regions[Region::kVirtual][Subject::kPainting] = {
      .coveredPercent = 9.5, .ew2 = 0.5, .nHw2 = 0.07, .popPercent = 2.5};
  with.models->regions[Region::kSeam][Subject::kFixed].popPercent = 12;
  const auto json = nlohmann::json::parse(reportJson(with))["models"];
  EXPECT_EQ(json["virtual"]["covered_percent"], 9.5);
  EXPECT_EQ(json["virtual"]["painting"]["nhw2"], 0.07);
  EXPECT_TRUE(json["virtual"]["painting"]["s10_percent"].is_null());
  EXPECT_EQ(json["seam"]["fixed"]["pop_percent"], 12);
  EXPECT_EQ(json["forgetting_ew2_ratio"], 7.5);
  EXPECT_EQ(json["anchors"]["slip"]["p95_px"], 0.02);
  EXPECT_TRUE(json["anchors"]["slip_over_10_frames"].is_null());
  EXPECT_THAT(reportText(with), AllOf(HasSubstr("VIRTUAL, models: 9.5 % of the frames"),
                                      HasSubstr("EW2 0.5, nHW2 0.07, POP 2.5 %, S10 –"),
                                      HasSubstr("80 anchors on what stays in sight"),
                                      HasSubstr("slip a frame: median 0.001 px")));
  EXPECT_THAT(reportHtml(with), AllOf(HasSubstr("<h2>Models</h2>"), HasSubstr("<td>0.07</td>"),
                                      HasSubstr("80 anchors on what stays in sight")));
}

TEST(Report, IsJsonWithNullForWhatCouldNotBeHad) {
  const auto json = nlohmann::json::parse(reportJson(report()));
  EXPECT_EQ(json["measures"]["painting"]["ew2"], 0.25);
  EXPECT_TRUE(json["measures"]["painting"]["scr"].is_null());
  const auto& passed = json["gates"][0];
  EXPECT_EQ(passed["value"], 0.0625);
  EXPECT_EQ(passed["limit"], 0.3);
  EXPECT_EQ(passed["sense"], "at most");
  EXPECT_EQ(passed["passed"], true);
  const auto& missing = json["gates"][1];
  EXPECT_EQ(missing["verdict"], "not measured");
  EXPECT_TRUE(missing["value"].is_null());
  EXPECT_EQ(missing["limit"], 90);
  EXPECT_EQ(missing["sense"], "at least");
  EXPECT_TRUE(missing["passed"].is_null());
  EXPECT_EQ(json["gates_passed"], false);
  EXPECT_EQ(json["controls_valid"], true);
  EXPECT_EQ(json["inside"]["drift"]["median_px"], 0.5);
  EXPECT_TRUE(json["inside"]["half_life_frames"].is_null());
  EXPECT_EQ(json["inside"]["half_life_over_frames"], 3);
  EXPECT_EQ(json["over_time"].size(), 3u);
}

TEST(Report, IsAPageThatNeedsNothingElse) {
  const std::string html = reportHtml(report());
  EXPECT_THAT(html,
              AllOf(HasSubstr("<!DOCTYPE html>"), HasSubstr("water&lt;color&gt; on in &amp; out"),
                    HasSubstr("<svg"), HasSubstr("data:image/png;base64,iVBORw0KGgo")));
  EXPECT_THAT(html,
              AllOf(Not(HasSubstr("http:")), Not(HasSubstr("https:")), Not(HasSubstr("<script")),
                    Not(HasSubstr("<link")), Not(HasSubstr("water<color>"))));
}

TEST(Report, LabelsAxesAndSaysHowMuchStrongerDifferencesAreShown) {
  Report marked = report();
  marked.worst.front().differenceGain = 20;
  EXPECT_THAT(reportHtml(marked), AllOf(HasSubstr(">mean square × 1000</text>"),
                                        HasSubstr(">frame</text>"), HasSubstr("difference × 20")));
}

TEST(Report, DoesNotTellAHalfLifeThatNobodySaw) {
  Report report;
  report.inside = AnchorSummary{.frames = 14, .innerDeaths = 0.2};
  EXPECT_THAT(insideLines(report), testing::Contains(HasSubstr("over 14 frames, for fewer")));
  report.inside->innerDeaths = 0;
  EXPECT_THAT(insideLines(report), testing::Contains(HasSubstr("in which none died")));
  report.inside->halfLifeFrames = 9.4;
  EXPECT_THAT(insideLines(report), testing::Contains(HasSubstr("longer than 9 frames")));
}

TEST(Report, SaysLoudlyThatControlsAreWrong) {
  Report wrong = report();
  EXPECT_TRUE(wrong.areControlsValid());
  EXPECT_THAT(reportText(wrong), Not(HasSubstr("MUST")));
  wrong.controls.push_back({"redrawn", Verdict::State::kFailed, "they pass"});
  EXPECT_FALSE(wrong.areControlsValid());
  EXPECT_THAT(reportText(wrong), AllOf(HasSubstr("WRONG"), HasSubstr("DO NOT READ AS THEY MUST")));
  EXPECT_THAT(reportHtml(wrong), HasSubstr("can be relied on"));
}

TEST(Report, PassesOnlyWhenEveryGateWasMeasured) {
  Report passed = report();
  EXPECT_FALSE(passed.areGatesPassed());
  passed.gates.pop_back();
  EXPECT_TRUE(passed.areGatesPassed());
}

TEST(Report, ShowsADashForWhatCouldNotBeHad) {
  const Measures none;
  for (const MeasureColumn& column : measureColumns()) EXPECT_EQ(textOf(column, none), "–");
}

}  // namespace
}  // namespace pleinair::measure
