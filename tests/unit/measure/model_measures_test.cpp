// The motion of pictures with virtual models, and the measures in each of their regions, on sheets
// that move over a panned picture.
#include <algorithm>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/measure/input/model_motion.h"
#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/measurement_report.h"
#include "pipeline/measure/model_anchors.h"
#include "pipeline/measure/model_gates.h"
#include "pipeline/measure/model_regions.h"
#include "pipeline/measure/sequence_measures.h"
#include "pipeline/styles/registry.h"
#include "tests/unit/measure/measure_pictures.h"

namespace pleinair::measure {
namespace {

using State = Verdict::State;

const cv::Size kFrame(260, 220);
const cv::Point kCameraPan(-2, -1);  // px a frame

/// A flat model: a rectangle that turns and moves in the plane of the image.
struct Sheet {
  int object = 1;
  int triangle = 0;
  cv::Point2f centre;  ///< in frame 0
  cv::Point2f velocity;
  float degrees = 0;  ///< a frame
  cv::Size2f size{90, 80};
  double growth = 1;  ///< of its sides, a frame

  /// From the sheet's own coordinates, in px from its centre.
  cv::Point2f placeOf(cv::Point2f own, double frame) const {
    const double angle = static_cast<double>(degrees) * frame * CV_PI / 180;
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    const auto t = static_cast<float>(frame);
    own *= std::pow(growth, frame);
    return centre + velocity * t + cv::Point2f(c * own.x - s * own.y, s * own.x + c * own.y);
  }
  cv::Point2f ownOf(cv::Point2f px, double frame) const {
    const double angle = static_cast<double>(degrees) * frame * CV_PI / 180;
    const auto c = static_cast<float>(std::cos(angle));
    const auto s = static_cast<float>(std::sin(angle));
    const cv::Point2f d = px - centre - velocity * static_cast<float>(frame);
    return cv::Point2f(c * d.x + s * d.y, -s * d.x + c * d.y) / std::pow(growth, frame);
  }
  bool holds(cv::Point2f own) const {
    return std::abs(own.x) <= size.width / 2 && std::abs(own.y) <= size.height / 2;
  }
  int id() const { return object << PaintedModels::kTriangleBits | triangle; }
};

/// Sheets, the last one in front, over a picture that the camera pans over.
class World {
 public:
  explicit World(std::vector<Sheet> sheets) : sheets_(std::move(sheets)) {}

  PaintedModels models(double frame) const {
    PaintedModels shown{.ids = cv::Mat1i(kFrame, 0),
                        .barycentrics = cv::Mat2f(kFrame, cv::Vec2f()),
                        .place = {},
                        .changed = {}};
    for (const Sheet& sheet : sheets_) {
      for (int y = 0; y < kFrame.height; ++y) {
        for (int x = 0; x < kFrame.width; ++x) {
          const cv::Point2f own = sheet.ownOf(cv::Point2f(cv::Point(x, y)), frame);
          if (!sheet.holds(own)) continue;
          shown.ids(y, x) = sheet.id();
          shown.barycentrics(y, x) = {own.x, own.y};
        }
      }
    }
    shown.changed = shown.mask();
    shown.place = [sheets = sheets_, frame](int id,
                                            const cv::Vec2f& at) -> std::optional<cv::Point2f> {
      const auto sheet = std::ranges::find(sheets, id, &Sheet::id);
      if (sheet == sheets.end()) return std::nullopt;
      return sheet->placeOf({at[0], at[1]}, frame);
    };
    return shown;
  }

  cv::Mat3f picture(int frame) const {
    const cv::Point at = cv::Point(60, 60) - frame * kCameraPan;
    cv::Mat3f picture = windowOf(ground_, at, kFrame);
    const PaintedModels shown = models(frame);
    cv::Mat2f onSheet(kFrame, cv::Vec2f());
    for (int y = 0; y < kFrame.height; ++y) {
      for (int x = 0; x < kFrame.width; ++x) {
        onSheet(y, x) = shown.barycentrics(y, x) + cv::Vec2f(100, 100);
      }
    }
    cv::Mat3f sheets;
    cv::remap(sheet_, sheets, onSheet, {}, cv::INTER_CUBIC);
    sheets.copyTo(picture, shown.mask());
    return toFloat(withSensorNoise(picture, 1.0, static_cast<std::uint64_t>(frame)).view());
  }

 private:
  std::vector<Sheet> sheets_;
  cv::Mat3f ground_ = strongBlobs({400, 340}, 1);
  cv::Mat3f sheet_ = strongBlobs({200, 200}, 2);
};

Sheet movingSheet() {
  return {.centre = {110, 105}, .velocity = {1.5F, 0.25F}};
}

MotionMap mapBetween(const World& world, std::uint64_t from, std::uint64_t to) {
  const auto camera = constantMotion(kFrame, kCameraPan);
  ModelMotion motion(camera.get());
  motion.add(from, world.models(static_cast<double>(from)));
  motion.add(to, world.models(static_cast<double>(to)));
  return *motion.between(from, to);
}

TEST(ModelMotion, IsTheModelsWhereOneIsSeenAndTheCamerasElsewhere) {
  const MotionMap map = mapBetween(World({movingSheet()}), 1, 3);
  ASSERT_FALSE(map.shift);
  const cv::Point onSheet(111, 105);
  EXPECT_NE(map.valid(onSheet), 0);
  EXPECT_LT(cv::norm(map.displacement(onSheet) - cv::Vec2f(3, 0.5F)), 1e-4);
  const cv::Point away(220, 180);
  EXPECT_NE(map.valid(away), 0);
  EXPECT_LT(cv::norm(map.displacement(away) - cv::Vec2f(-4, -2)), 1e-4);
  // From the left edge at 66.5 on, 3 px on both sides are left out.
  for (const int x : {65, 66, 67, 68}) EXPECT_EQ(map.valid(105, x), 0) << x;
  // Just right of the sheet, whose edge is at 156.5, the picture goes under it.
  for (const int x : {158, 160, 162}) EXPECT_EQ(map.valid(105, x), 0) << x;
}

TEST(ModelMotion, FollowsATurnOverTenFramesWithoutAddingErrors) {
  Sheet turning = movingSheet();
  turning.degrees = 2;
  const MotionMap map = mapBetween(World({turning}), 0, 10);
  int judged = 0;
  for (int y = 80; y < 130; ++y) {
    for (int x = 90; x < 130; ++x) {
      if (map.valid(y, x) == 0) continue;
      const cv::Point2f px(cv::Point(x, y));
      const cv::Point2f by = turning.placeOf(turning.ownOf(px, 0), 10) - px;
      EXPECT_LT(cv::norm(map.displacement(y, x) - cv::Vec2f(by.x, by.y)), 1e-3);
      ++judged;
    }
  }
  EXPECT_GT(judged, 1500);
}

/// Also where the thing in front is a part of the same model.
TEST(ModelMotion, LeavesOutWhatSomethingElseHidesLater) {
  const Sheet behind = movingSheet();
  for (const int object : {1, 2}) {
    Sheet front{.object = object,
                .triangle = 7,
                .centre = {110, 40},
                .velocity = {1.5F, 6.0F},
                .size = {40, 20}};
    const MotionMap map = mapBetween(World({behind, front}), 0, 8);  // it is at (122, 88) then
    const cv::Point hidden(110, 86);  // (122, 88) on the sheet behind
    EXPECT_EQ(map.valid(hidden), 0) << object;
    EXPECT_NE(mapBetween(World({behind}), 0, 8).valid(hidden), 0);
    EXPECT_NE(map.valid(120, 110), 0) << object;
  }
}

TEST(ModelMotion, KnowsModelsBeforeAnUnknownCamera) {
  const World world({movingSheet()});
  ModelMotion motion(nullptr);
  motion.add(0, world.models(0));
  motion.add(2, world.models(2));
  const MotionMap map = *motion.between(0, 2);
  EXPECT_NE(map.valid(105, 110), 0);
  EXPECT_EQ(map.valid(180, 220), 0);
  const MotionMap none = *motion.forgettingModels(0, 2);
  EXPECT_EQ(none.displacement(105, 110), cv::Vec2f());
}

/// A painting as a function of the picture, the mask of models and the frame's number.
using Painting = std::function<cv::Mat3f(const cv::Mat3f&, const cv::Mat1b&, int)>;

cv::Mat3f faithful(const cv::Mat3f& picture, const cv::Mat1b&, int) {
  return picture;
}

/// A stroke set that is bound to the screen, on models only.
cv::Mat3f fixedOnModels(const cv::Mat3f& picture, const cv::Mat1b& models, int) {
  cv::Mat3f painting = picture.clone();
  VoronoiTiling(picture.size(), 5).paint(picture).copyTo(painting, models);
  return painting;
}

cv::Mat3f redrawnOnTheGround(const cv::Mat3f& picture, const cv::Mat1b& models, int frame) {
  cv::Mat3f painting =
      VoronoiTiling(picture.size(), 100 + static_cast<std::uint64_t>(frame)).paint(picture);
  picture.copyTo(painting, models);
  return painting;
}

/// What the truth is told of the models.
using Told = std::function<PaintedModels(const World&, int)>;

PaintedModels truth(const World& world, int frame) {
  return world.models(frame);
}

/// Points of models are said to move as the picture behind them does.
PaintedModels forgetful(const World& world, int frame) {
  PaintedModels told = world.models(frame);
  Sheet sheet = movingSheet();
  sheet.velocity = kCameraPan;
  for (int y = 0; y < kFrame.height; ++y) {
    for (int x = 0; x < kFrame.width; ++x) {
      const cv::Point2f own = sheet.ownOf(cv::Point2f(cv::Point(x, y)), frame);
      told.barycentrics(y, x) = {own.x, own.y};
    }
  }
  told.place = World({sheet}).models(frame).place;
  return told;
}

ModelReport reportOf(const Painting& paint, const Told& tell = truth) {
  const World world({movingSheet()});
  const auto camera = constantMotion(kFrame, kCameraPan);
  ModelMotion motion(camera.get());
  SequenceMeasures measures(kFrame, &motion, &motion);
  for (int t = 0; t < 14; ++t) {
    const PaintedModels models = tell(world, t);
    motion.add(static_cast<std::uint64_t>(t), models);
    const cv::Mat3f picture = world.picture(t);
    EXPECT_TRUE(
        measures.add(static_cast<std::uint64_t>(t), picture, paint(picture, models.mask(), t), {}));
  }
  return {.regions = measures.regions().summary(),
          .forgettingRatio = measures.regions().forgettingRatio(),
          .anchors = {}};
}

styles::CoherenceGates painterlyGates() {
  styles::CoherenceGates gates = styles::styleKind("painterly").coherence;
  gates.holdsAnchors = false;
  return gates;
}

std::vector<std::string> failedGates(const ModelReport& report) {
  std::vector<std::string> failed;
  for (const Verdict& verdict : modelVerdicts(report, painterlyGates())) {
    if (verdict.state == State::kFailed) {
      failed.push_back(verdict.what.substr(0, verdict.what.find(' ', verdict.what.find(' ') + 1)));
    }
  }
  return failed;
}

TEST(ModelRegions, AreAllPassedByAPaintingThatFollowsEverything) {
  const ModelReport report = reportOf(faithful);
  for (const Region region : kAllRegions) {
    const RegionSummary& painting = report.regions[region][Subject::kPainting];
    ASSERT_TRUE(painting.nHw2) << descriptionOf(region);
    EXPECT_LT(*painting.nHw2, 0.02) << descriptionOf(region);
    EXPECT_LT(*painting.popPercent, 0.1) << descriptionOf(region);
  }
  const RegionSummary& sheet = report.regions[Region::kVirtual][Subject::kPainting];
  EXPECT_EQ(sheet.s10Percent, 100.0);
  EXPECT_GT(sheet.coveredPercent, 25);
  EXPECT_THAT(failedGates(report), testing::IsEmpty());
  for (const Verdict& verdict : modelControlVerdicts(report, painterlyGates())) {
    EXPECT_EQ(verdict.state, State::kPassed) << verdict.what << ": " << verdict.found;
  }
}

TEST(ModelRegions, TellMarksThatAreBoundToTheScreenOnModels) {
  const ModelReport report = reportOf(fixedOnModels);
  EXPECT_THAT(failedGates(report), testing::Contains("VIRTUAL nHW2"));
  EXPECT_THAT(failedGates(report), testing::Contains("VIRTUAL S10"));
  EXPECT_THAT(failedGates(report), testing::Contains("VIRTUAL POP"));
  EXPECT_THAT(failedGates(report), testing::Not(testing::Contains("REAL nHW2")));
}

TEST(ModelRegions, TellMarksThatFlickerBesideModels) {
  const ModelReport report = reportOf(redrawnOnTheGround);
  EXPECT_THAT(failedGates(report), testing::Contains("REAL nHW2"));
  EXPECT_THAT(failedGates(report), testing::Contains("SEAM POP"));
  EXPECT_THAT(failedGates(report), testing::Not(testing::Contains("VIRTUAL nHW2")));
}

TEST(ModelRegions, SayThatATruthForgetsTheModels) {
  const ModelReport report = reportOf(faithful, forgetful);
  const auto controls = modelControlVerdicts(report, painterlyGates());
  EXPECT_EQ(controls[0].state, State::kFailed) << controls[0].what << controls[0].found;
  EXPECT_GT(*report.regions[Region::kVirtual][Subject::kInput].nHw2, 0.8);
}

TEST(ModelGates, TakeTheInputsReadingWhereItIsWorse) {
  ModelReport report;
  report.regions[Region::kVirtual][Subject::kInput] = {
      .nHw2 = 0.3, .popPercent = 6, .s10Percent = 50};
  report.regions[Region::kVirtual][Subject::kPainting] = {
      .nHw2 = 0.31, .popPercent = 5.9, .s10Percent = 51};
  EXPECT_THAT(failedGates(report), testing::ElementsAre("VIRTUAL nHW2"));
  report.regions[Region::kVirtual][Subject::kInput] = {
      .nHw2 = 0.1, .popPercent = 1, .s10Percent = 99};
  EXPECT_THAT(failedGates(report),
              testing::ElementsAre("VIRTUAL nHW2", "VIRTUAL POP", "VIRTUAL S10"));
}

TEST(ModelGates, ControlsThatPassAreWrong) {
  ModelReport report;
  report.forgettingRatio = 1.2;
  for (const Region region : kAllRegions) {
    for (const Subject subject : kAllSubjects) {
      report.regions[region][subject] = {.nHw2 = 0.1, .popPercent = 1, .s10Percent = 95};
    }
  }
  report.regions[Region::kVirtual][Subject::kInput].nHw2 = 0.6;
  const auto controls = modelControlVerdicts(report, painterlyGates());
  ASSERT_EQ(controls.size(), 4u);
  for (const Verdict& verdict : controls) {
    // Redrawn marks are judged by nHW2 0.1, which is better than the input's.
    EXPECT_EQ(verdict.state, State::kFailed) << verdict.what;
  }
  for (const Verdict& verdict : modelControlVerdicts({}, painterlyGates())) {
    EXPECT_EQ(verdict.state, State::kNotMeasured) << verdict.what;
    EXPECT_NE(verdict.found, "");
  }
}

/// Anchors in a grid over the sheet, which move by this much a frame.
std::vector<marks::Anchor> anchorsAt(int frame, cv::Point2f velocity, std::uint32_t seed) {
  std::vector<marks::Anchor> anchors;
  for (int row = 0; row < 5; ++row) {
    for (int column = 0; column < 5; ++column) {
      marks::Anchor anchor;
      anchor.px = {90.5F + static_cast<float>(column * 8) + velocity.x * static_cast<float>(frame),
                   90.5F + static_cast<float>(row * 7) + velocity.y * static_cast<float>(frame)};
      anchor.seed = seed + static_cast<std::uint32_t>(anchors.size());
      anchor.state = marks::Anchor::kAlive;
      anchors.push_back(anchor);
    }
  }
  return anchors;
}

ModelAnchorSummary anchorsOver(const std::function<std::vector<marks::Anchor>(int)>& anchors,
                               const Sheet& sheet = movingSheet()) {
  const World world({sheet});
  ModelMotion motion(nullptr);
  ModelAnchors measured(kFrame);
  for (int t = 0; t < 13; ++t) {
    const auto now = static_cast<std::uint64_t>(t);
    motion.add(now, world.models(t));
    std::optional<MotionMap> last, back, ten;
    if (t > 0) last = motion.ofModels(now - 1, now);
    if (t > 0) back = motion.ofModels(now, now - 1);
    if (t >= 10) ten = motion.ofModels(now - 10, now);
    measured.add(anchors(t), {.sinceLast = last ? &*last : nullptr,
                              .toLast = back ? &*back : nullptr,
                              .sinceLong = ten ? &*ten : nullptr});
  }
  return measured.summary().value();
}

TEST(ModelAnchors, RideOnAModelWithoutSlip) {
  const auto riding = anchorsOver([](int t) { return anchorsAt(t, movingSheet().velocity, 1); });
  EXPECT_EQ(riding.anchors, 25);
  EXPECT_EQ(riding.turnoverPercent, 0);
  EXPECT_LT(riding.resizedPercent, 1e-3);
  EXPECT_LT(riding.slip->percentile95, 1e-3);
  EXPECT_LT(riding.longSlip->percentile95, 1e-3);
}

TEST(ModelAnchors, KnowHowMuchAModelGrowsOrShrinks) {
  const auto still = [](int) { return anchorsAt(0, {}, 1); };
  Sheet sheet = movingSheet();
  for (const double growth : {1.01, 0.99}) {
    sheet.growth = growth;
    EXPECT_NEAR(anchorsOver(still, sheet).resizedPercent, 2, 0.03) << growth;
  }
}

TEST(ModelGates, CountNoMarksThatASizeAsksFor) {
  styles::CoherenceGates gates;
  gates.holdsAnchors = true;
  ModelReport report;
  report.anchors = ModelAnchorSummary{.turnoverPercent = 3.5, .resizedPercent = 1.6};
  EXPECT_EQ(modelVerdicts(report, gates).back().state, State::kPassed);
  report.anchors->resizedPercent = 1.4;
  EXPECT_EQ(modelVerdicts(report, gates).back().state, State::kFailed);
}

TEST(ModelAnchors, SlipWhereTheCameraCarriesThem) {
  const auto carried = anchorsOver([](int t) { return anchorsAt(t, {-0.5F, 0.25F}, 1); });
  EXPECT_NEAR(carried.slip->median, 2.0, 0.01);
  EXPECT_NEAR(carried.longSlip->median, 20.0, 0.01);
}

TEST(ModelAnchors, CountBirthsAndDeathsOnWhatStaysInSight) {
  const auto reborn = anchorsOver([](int t) {
    // Each frame, one of 25 is another one.
    std::vector<marks::Anchor> anchors = anchorsAt(t, movingSheet().velocity, 1);
    for (int i = 0; i <= t; ++i) anchors[static_cast<std::size_t>(i)].seed += 1000;
    return anchors;
  });
  EXPECT_NEAR(reborn.births, 1, 1e-9);
  EXPECT_NEAR(reborn.deaths, 1, 1e-9);
  EXPECT_NEAR(reborn.turnoverPercent, 8, 1e-9);
}

TEST(StillMeasures, CountNothingWhereModelsAre) {
  const cv::Mat3f wall = strongBlobs(kFrame, 3);
  const auto flickerOf = [&](bool ignores) {
    StillMeasures still(kFrame);
    for (int t = 0; t < 4; ++t) {
      cv::Mat1b models(kFrame, 0);  // they move on
      models(cv::Rect(70 + 20 * t, 90, 60, 40)).setTo(255);
      const cv::Mat3f input =
          toFloat(withSensorNoise(wall, 2.0, static_cast<std::uint64_t>(t)).view());
      cv::Mat3f output = wall.clone();
      output.setTo(cv::Scalar::all(t % 2), models);
      still.add(input, output, ignores ? &models : nullptr);
    }
    return *still.flicker(Subject::kPainting);
  };
  EXPECT_GT(flickerOf(false), 5);
  EXPECT_EQ(flickerOf(true), 0);
}

}  // namespace
}  // namespace pleinair::measure
