// `pleinair measure --standing`: what moves before a camera that stands.
#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tests/program/measure_fixture.h"

namespace pleinair::support {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class MeasureMovers : public Measure {
 protected:
  /// A standing camera before which a bar passes once, from the left to the right.
  void writeVisit() {
    constexpr int kFrames = 75;
    constexpr int kFramesUntilItComes = 6;
    constexpr int kSpeedPx = 8;  // a frame
    constexpr int kWidthPx = 24;
    std::filesystem::create_directory(path("in"));
    for (int i = 0; i < kFrames; ++i) {
      const int left = (i - kFramesUntilItComes) * kSpeedPx - kWidthPx;
      writePicture("in/" + std::to_string(100 + i) + ".png", 0, 0, kSize, [&](int x, int y) {
        return x >= left && x < left + kWidthPx && y >= 50 && y < 130;
      });
    }
  }
};

TEST_F(MeasureMovers, ComparesMoversWithTheirTrueMasks) {
  // Ten frames a second: the hand comes after 1.5 s, and rests from 3.2 s on.
  const std::vector<std::string> arguments{
      "--camera", "synthetic:hand", "--standing",  "--size", "208x160",
      "--set",    "camera.rate=10", "--frames",    "45",     "--settle",
      "5",        "--json",         path("r.json")};
  std::vector<std::string> painted = arguments;
  painted.insert(painted.end(), {"--style", "painterly"});
  const ProgramRun run = measured(painted);
  ASSERT_EQ(run.status, 0) << run.error << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("true masks of movers"), HasSubstr("MOVER nHW2"),
                             HasSubstr("IoU with the true masks"), HasSubstr("was labelled")));
  auto json = nlohmann::json::parse(read("r.json"));
  EXPECT_EQ(json["movers"]["masks"], "true");
  EXPECT_GT(json["movers"]["painting"]["covered_percent"], 3.0);
  EXPECT_TRUE(json["movers"]["along_motion"]["painting"]["mover_pop_percent"].is_number());
  EXPECT_TRUE(json["movers"]["along_motion"]["painting"]["seam_pop_percent"].is_number());
  EXPECT_GT(json["labels"]["iou_mean"], 0.4);
  EXPECT_LT(json["labels"]["iou_displaced_masks"], 0.8);
  EXPECT_EQ(json["labels"]["still_flips_percent"], 0.0);
  ASSERT_EQ(json["labels"]["detections"].size(), 1u);
  EXPECT_EQ(json["labels"]["detections"][0]["found"], true);
  EXPECT_LE(json["labels"]["detections"][0]["frames"], 3);

  std::vector<std::string> plain = arguments;
  plain.insert(plain.end(), {"--style", "none"});
  const ProgramRun unlabelled = measured(plain);
  ASSERT_EQ(unlabelled.status, 0) << unlabelled.error << unlabelled.out;
  EXPECT_THAT(unlabelled.out, Not(HasSubstr("IoU with the true masks")));
  json = nlohmann::json::parse(read("r.json"));
  EXPECT_TRUE(json["labels"].is_null());
  EXPECT_LT(json["movers"]["painting"]["lost_percent"], 1.0);
}

/// The gates of movers that say something about a shot of the synthetic camera, at 15 frames a
/// second.
struct MoverShot {
  const char* description;
  const char* shot;
  const char* frames;
  std::vector<const char*> gates;  ///< their beginnings
  double leastIou;
};

class MoverGates : public MeasureMovers {
 protected:
  nlohmann::json measuredOil(const MoverShot& shot, const std::string& movers) {
    const ProgramRun run =
        measured({"--camera", std::string("synthetic:") + shot.shot, "--standing", "--size",
                  "320x240", "--set", "camera.rate=15", "--frames", shot.frames, "--settle", "5",
                  "--style", "painterly", "--set", "movers=" + movers, "--json", path("r.json")});
    EXPECT_EQ(run.status, 0) << run.error << run.out;
    return nlohmann::json::parse(read("r.json"));
  }
  static std::string verdictOf(const nlohmann::json& report, const std::string& gate) {
    for (const auto& each : report["gates"]) {
      if (each["what"].get<std::string>().starts_with(gate)) return each["verdict"];
    }
    return "absent";
  }
};

class MoverGatesOf : public MoverGates, public testing::WithParamInterface<MoverShot> {};

TEST_P(MoverGatesOf, ArePassedByOil) {
  const nlohmann::json report = measuredOil(GetParam(), "true");
  for (const char* const gate : GetParam().gates) {
    EXPECT_EQ(verdictOf(report, gate), "pass") << gate << report["gates"];
  }
  if (GetParam().leastIou > 0.0) {
    EXPECT_GT(report["labels"]["iou_mean"], GetParam().leastIou);
  }
}

/// A control: a painter of one layer.
TEST_F(MoverGates, AreFailedWithoutLayers) {
  const nlohmann::json report = measuredOil({.shot = "hand", .frames = "70"}, "false");
  for (const char* const gate : {"RETURN", "GHOST"}) {
    EXPECT_EQ(verdictOf(report, gate), "fail") << gate << report["gates"];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shots, MoverGatesOf,
    testing::Values(
        MoverShot{"Hand",
                  "hand",
                  "70",
                  {"STILL", "RETURN", "GHOST", "SEAM POP", "LOST", "frames until"},
                  0.8},
        MoverShot{"Lights", "lights", "60", {"STILL", "FOLLOW", "labels that flip where"}, 0.0}),
    [](const auto& shot) { return std::string(shot.param.description); });

/// A violet bar crosses a wall of squares; the recording goes on for over a second after that.
TEST_F(MeasureMovers, JudgesMoversBeforeAStandingCamera) {
  writeVisit();
  const ProgramRun run =
      measured({"--input", path("in"), "--standing", "--style", "none", "--json", path("r.json")});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, AllOf(HasSubstr("of the frames"), HasSubstr("STILL"), HasSubstr("RETURN"),
                             HasSubstr("GHOST"), HasSubstr("LOST")));
  const auto json = nlohmann::json::parse(read("r.json"));
  const auto& movers = json["movers"];
  // The bar covers 80 of the 100 rows within the border, each of their pixels in 3 of 75 frames.
  EXPECT_NEAR(movers["painting"]["covered_percent"], 3.2, 0.2);
  EXPECT_EQ(movers["painting"]["still_percent"], 0.0);
  EXPECT_EQ(movers["painting"]["return_levels"], 0.0);
  EXPECT_EQ(movers["painting"]["ghost"], 0.0);
  EXPECT_LT(movers["painting"]["lost_percent"], 1.0);
  EXPECT_GT(movers["averaging"]["lost_percent"], 15.0) << "the control";
  EXPECT_GT(movers["averaging"]["ghost"], 0.05) << "the control";
  EXPECT_EQ(json["controls_valid"], true);
  EXPECT_EQ(json["measures"]["painting"]["ew2"], nullptr) << "the motion is not known";
  const auto isOfMovers = [](const nlohmann::json& gate) {
    return gate["what"].get<std::string>().starts_with("RETURN");
  };
  EXPECT_TRUE(std::ranges::any_of(json["gates"], isOfMovers));
}

TEST_F(MeasureMovers, DoesNotLookForMoversUnlessTheCameraStands) {
  writeVisit();
  const ProgramRun run =
      measured({"--input", path("in"), "--style", "none", "--json", path("r.json")});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, testing::Not(HasSubstr("movers cover")));
  EXPECT_EQ(nlohmann::json::parse(read("r.json"))["movers"], nullptr);
}

/// If a pan is measured with --standing, everything is a mover, and nothing is left to compare.
TEST_F(MeasureMovers, ACameraThatDoesNotStandLeavesMoversUnjudged) {
  writePan(24);
  std::filesystem::remove(path("in/motion.json"));
  const ProgramRun run =
      measured({"--input", path("in"), "--standing", "--style", "none", "--json", path("r.json")});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, HasSubstr("no mover came and went"));
  const auto movers = nlohmann::json::parse(read("r.json"))["movers"]["painting"];
  EXPECT_GT(movers["covered_percent"], 95.0);
  for (const char* name : {"still_percent", "return_levels", "ghost", "lost_percent"}) {
    EXPECT_EQ(movers[name], nullptr) << name;
  }
}

}  // namespace
}  // namespace pleinair::support
