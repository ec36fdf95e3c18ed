// `pleinair measure`: its report, its exit status, and one line for whatever is wrong with its
// input.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numbers>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "hal/media/picture_file.h"
#include "tests/program/program.h"
#include "tests/support/deep_png.h"
#include "tests/support/media_files.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::support {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr hal::FrameSize kSize{200, 180};

class Measure : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  std::string read(const std::string& name) const {
    std::ifstream file(path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  /// Squares of many colours, from a place on; violet where `isMover` says so.
  void writePicture(
      const std::string& name, int fromX, int fromY, hal::FrameSize size = kSize,
      const std::function<bool(int, int)>& isMover = [](int, int) { return false; }) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size, .encoding = {}});
    for (int y = 0; y < size.height; ++y) {
      const auto row = image.row(0, y);
      for (int x = 0; x < size.width; ++x) {
        const auto cell = static_cast<unsigned>((x + fromX) / 9 * 7919 + (y + fromY) / 7 * 104729);
        for (unsigned c = 0; c < 3; ++c) {
          row[3 * static_cast<std::size_t>(x) + c] =
              static_cast<std::uint8_t>((cell * (c + 3) * 2654435761U) >> 24U);
          if (isMover(x, y)) row[3 * static_cast<std::size_t>(x) + c] = c == 1 ? 0 : 255;
        }
      }
    }
    hal::orThrow(hal::writePng(path(name), image.view()));
  }

  /// A pan of (-2, -1) px a frame over them.
  void writePan(int frames) {
    std::filesystem::create_directory(path("in"));
    for (int i = 0; i < frames; ++i) {
      writePicture("in/" + std::to_string(i) + ".png", 2 * i, i);
    }
    write("in/motion.json", R"({"v": [-2, -1]})");
  }

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

  static ProgramRun measured(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "measure");
    return runProgram(arguments);
  }

  static void expectRefused(const std::vector<std::string>& arguments,
                            const testing::Matcher<std::string>& error) {
    const ProgramRun run = measured(arguments);
    EXPECT_EQ(run.status, 2) << run.error;
    EXPECT_THAT(run.error, AllOf(error, testing::StartsWith("pleinair: ")));
    EXPECT_EQ(std::ranges::count(run.error, '\n'), 1) << run.error;
    EXPECT_EQ(run.out, "");
  }

  TemporaryFolder folder_;
};

TEST_F(Measure, ReadsTheInputItselfThroughStyleNone) {
  writePan(13);
  const ProgramRun run = measured({"--input", path("in"), "--style", "none", "--json",
                                   path("r.json"), "--html", path("r.html")});
  ASSERT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, AllOf(HasSubstr("pan by (-2, -1) px a frame"), HasSubstr("nHW2"),
                             HasSubstr("valid")));
  const auto json = nlohmann::json::parse(read("r.json"));
  const auto& own = json["measures"]["painting"];
  EXPECT_EQ(json["frames"], 13);
  EXPECT_EQ(own["ew2"], 0.0);
  EXPECT_EQ(own["s10_percent"], 100.0);
  EXPECT_EQ(own["xflk"], 1.0);
  EXPECT_GT(json["measures"]["redrawn"]["nhw2"], 0.4);
  EXPECT_GT(json["measures"]["fixed"]["scr"], 0.25);
  EXPECT_THAT(read("r.html"), AllOf(HasSubstr("<svg"), HasSubstr("data:image/png")));
}

TEST_F(Measure, ComparesMoversWithTheirTrueMasks) {
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

class MoverGates : public Measure {
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
  for (const char* const gate : {"RETURN", "GHOST", "SEAM POP"}) {
    EXPECT_EQ(verdictOf(report, gate), "fail") << gate << report["gates"];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Shots, MoverGatesOf,
    testing::Values(MoverShot{"Hand",
                              "hand",
                              "70",
                              {"STILL", "RETURN", "GHOST", "SEAM POP", "LOST", "frames until"},
                              0.8},
                    MoverShot{"Lights", "lights", "60", {"STILL", "labels that flip where"}, 0.0}),
    [](const auto& shot) { return std::string(shot.param.description); });

/// A model that stands on the workbench's first tag.
struct BenchModel {
  const char* description;
  const char* file;   ///< of the shared data; empty: none
  const char* table;  ///< the rest of its [[model]]
  const char* shot;
};

/// Models before the synthetic camera, at 15 frames a second and 320x240.
class MeasureModels : public Measure {
 protected:
  /// Writes the workbench's scene with this model alone. False where its file is not there.
  bool writeScene(const BenchModel& model) {
    std::string source = model.table;
    if (std::string_view(model.file) == "vase") {
      source = "source = \"vase.glb\"\n" + source;
      const std::string bytes = breathingVase();
      write("vase.glb", bytes);
    } else if (*model.file != 0) {
      const std::filesystem::path from =
          std::filesystem::path(PLEINAIR_SHARED_DATA) / "models" / model.file;
      if (!std::filesystem::exists(from)) return false;
      std::filesystem::copy_file(from, path(model.file));
      source = fmt::format("source = \"{}\"\n{}", model.file, source);
    }
    const ProgramRun run =
        runProgram({"record", "--camera", "synthetic", "--size", "320x240", "--frames", "1",
                    "--output", path("bench.mp4"), "--write-scene", path("bench.toml")});
    EXPECT_EQ(run.status, 0) << run.error;
    const std::string bench = read("bench.toml");
    write("scene.toml",
          bench.substr(0, bench.find("[[model]]")) + "[[model]]\nattach = \"tag:0\"\n" + source);
    return true;
  }

  ProgramRun measuredScene(const std::string& shot, std::vector<std::string> more) {
    std::vector<std::string> arguments{
        "--camera",       "synthetic:" + shot, "--size",  "320x240",         "--set",
        "camera.rate=15", "--frames",          "13",      "--settle",        "4",
        "--json",         path("r.json"),      "--scene", path("scene.toml")};
    arguments.insert(arguments.begin(), "measure");
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runProgram(arguments, {.time = std::chrono::seconds(280)});
  }
  nlohmann::json reportOf(const std::string& shot, const std::vector<std::string>& more) {
    const ProgramRun run = measuredScene(shot, more);
    EXPECT_EQ(run.status, 0) << run.error << run.out;
    return nlohmann::json::parse(read("r.json"));
  }
  static nlohmann::json verdictOf(const nlohmann::json& verdicts, const std::string& beginning) {
    for (const auto& each : verdicts) {
      if (each["what"].get<std::string>().starts_with(beginning)) return each;
    }
    ADD_FAILURE() << "no verdict on " << beginning;
    return nullptr;
  }

 private:
  static std::string breathingVase();
};

/// A tube of many colours whose belly swells and shrinks, once a second.
std::string MeasureModels::breathingVase() {
  constexpr int kAround = 24;
  constexpr int kUp = 16;
  std::vector<float> positions, swelling, colours;
  const auto add = [&](int i, int k) {
    const double angle = 2 * std::numbers::pi * i / kAround;
    const double height = static_cast<double>(k) / kUp;
    const double belly = std::sin(std::numbers::pi * height);
    for (const double each : {0.12 * std::cos(angle), 0.3 * height, 0.12 * std::sin(angle)}) {
      positions.push_back(static_cast<float>(each));
    }
    for (const double each :
         {0.08 * belly * std::cos(angle), 0.0, 0.08 * belly * std::sin(angle)}) {
      swelling.push_back(static_cast<float>(each));
    }
  };
  for (int k = 0; k < kUp; ++k) {
    for (int i = 0; i < kAround; ++i) {
      for (const auto& [di, dk] : {std::pair(0, 0), std::pair(0, 1), std::pair(1, 1),
                                   std::pair(0, 0), std::pair(1, 1), std::pair(1, 0)}) {
        add(i + di, k + dk);
        const auto cell = static_cast<unsigned>(i * 7919 + k * 104729);
        for (unsigned c = 0; c < 3; ++c) {
          colours.push_back(static_cast<float>((cell * (c + 3) * 2654435761U) >> 24U) / 255.0F);
        }
      }
    }
  }
  scene::GltfBuilder builder;
  auto& primitive = builder.addMesh(positions, "vase");
  primitive["targets"] = {{{"POSITION", builder.addFloats(swelling, "VEC3", 3)}}};
  primitive["attributes"]["COLOR_0"] = builder.addFloats(colours, "VEC3", 3);
  builder.root["materials"] = {{{"doubleSided", true}}};
  primitive["material"] = 0;
  const int times = builder.addFloats({0.0F, 0.5F, 1.0F}, "SCALAR", 1);
  const int weights = builder.addFloats({0.0F, 1.0F, 0.0F}, "SCALAR", 1);
  builder.root["animations"] = {
      {{"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}}}},
       {"samplers", {{{"input", times}, {"output", weights}}}}}};
  const auto bytes = builder.bytes();
  return {bytes.begin(), bytes.end()};
}

constexpr BenchModel kGearbox{
    "Gearbox", "",
    "source = \"builtin:gearbox\"\nlength_m = 0.6\nspeed_rpm = 60\nrotation_deg = [0, 0, 12]\n",
    "still"};
constexpr BenchModel kFox{"Fox", "Fox.glb",
                          "scale = 0.0045\nclip = \"Walk\"\nrotation_deg = [0, 0, 60]\n", "still"};

class TruthOf : public MeasureModels, public testing::WithParamInterface<BenchModel> {};

/// The picture with models, unpainted, is as coherent as a picture of the camera: its pixels are
/// where the truth says. Were the models' motion forgotten, or another, it would not be so.
TEST_P(TruthOf, IsFollowedByThePictureItself) {
  if (!writeScene(GetParam())) GTEST_SKIP() << "needs the shared model " << GetParam().file;
  const nlohmann::json report = reportOf(GetParam().shot, {"--style", "none"});
  EXPECT_EQ(report["controls_valid"], true) << report["controls"];
  const nlohmann::json& models = report["models"];
  EXPECT_GT(models["virtual"]["covered_percent"], 3.0);
  EXPECT_LT(models["virtual"]["painting"]["nhw2"], 0.25);
  EXPECT_LT(models["real"]["painting"]["nhw2"], 0.05);
  EXPECT_GT(models["virtual"]["redrawn"]["nhw2"], 0.5);
  EXPECT_LT(models["real"]["painting"]["pop_percent"], 1.0);
  EXPECT_THAT(report["motion"], HasSubstr("and the models' own motion"));
}

INSTANTIATE_TEST_SUITE_P(
    Models, TruthOf,
    testing::Values(kGearbox, kFox,
                    BenchModel{"FoxWalkedAround", "Fox.glb", kFox.table, "walkaround"},
                    BenchModel{"Figure", "RiggedFigure.glb", "scale = 0.4\n", "dolly"},
                    BenchModel{"Engine", "2CylinderEngine.glb",
                               "scale = 0.001\nrotation_deg = [0, 0, 30]\n", "roll"},
                    BenchModel{"Morphing", "vase", "", "walkaround"}),
    [](const auto& instance) { return std::string(instance.param.description); });

TEST_F(MeasureModels, TellATruthThatForgetsTheFoxAndMarksBoundToTheScreen) {
  if (!writeScene(kFox)) GTEST_SKIP() << "needs the shared model " << kFox.file;
  const nlohmann::json report = reportOf(kFox.shot, {"--style", "none"});
  const nlohmann::json forgetting = verdictOf(report["controls"], "motion that forgets the models");
  EXPECT_EQ(forgetting["verdict"], "pass");
  EXPECT_GT(forgetting["value"], 5.0);
  EXPECT_EQ(verdictOf(report["controls"], "marks fixed to the screen fail them")["verdict"],
            "pass");
  EXPECT_EQ(verdictOf(report["controls"], "marks redrawn each frame fail VIRTUAL")["verdict"],
            "pass");
}

TEST_F(MeasureModels, TellMarksOnModelsFromThoseOfAPlainVideo) {
  if (!writeScene(kFox)) GTEST_SKIP() << "needs the shared model " << kFox.file;
  const nlohmann::json bound =
      reportOf(kFox.shot, {"--style", "painterly", "--html", path("r.html")})["models"];
  EXPECT_THAT(read("r.html"), AllOf(HasSubstr("<h2>Models</h2>"), HasSubstr("VIRTUAL")));
  const nlohmann::json plain =
      reportOf(kFox.shot, {"--style", "painterly", "--image-space"})["models"];
  EXPECT_GT(bound["anchors"]["anchors"], 50);
  EXPECT_LT(bound["anchors"]["slip"]["p95_px"], 0.05);
  EXPECT_LT(bound["anchors"]["slip_over_10_frames"]["p95_px"], 0.05);
  EXPECT_GT(plain["anchors"]["slip_over_10_frames"]["p95_px"], 1.0);
  EXPECT_LT(bound["virtual_moving"]["painting"]["nhw2"],
            plain["virtual_moving"]["painting"]["nhw2"]);
  // The same film is painted.
  EXPECT_NEAR(bound["virtual"]["input"]["ew2"], plain["virtual"]["input"]["ew2"], 1e-3);
}

TEST_F(MeasureModels, JudgesEachRegion) {
  ASSERT_TRUE(writeScene(kGearbox));
  const ProgramRun run = measuredScene(kGearbox.shot, {"--style", "painterly"});
  ASSERT_EQ(run.status, 0) << run.error << run.out;
  EXPECT_THAT(run.out, AllOf(HasSubstr("VIRTUAL, models"), HasSubstr("SEAM, 8 px"),
                             HasSubstr("anchors on what stays in sight")));
  const auto report = nlohmann::json::parse(read("r.json"));
  for (const char* const gate :
       {"REAL nHW2", "REAL POP", "REAL S10", "VIRTUAL nHW2", "VIRTUAL POP", "SEAM POP",
        "slip of marks on models", "births and deaths on models"}) {
    EXPECT_NE(verdictOf(report["gates"], gate)["verdict"], "not measured") << gate;
  }
  EXPECT_EQ(verdictOf(report["gates"], "slip of marks on models")["verdict"], "pass");
}

TEST_F(MeasureModels, RefusesWhatModelsCannotBeMeasuredWith) {
  expectRefused({"--image-space", "--style", "none"},
                AllOf(HasSubstr("--image-space"), HasSubstr("--scene")));
  ASSERT_TRUE(writeScene(kGearbox));
  expectRefused({"--size", "320x240", "--scene", path("scene.toml"), "--quality", "low"},
                AllOf(HasSubstr("--quality"), HasSubstr("models")));
}

TEST_F(Measure, MakesAFailedGateAnExitStatus) {
  writePicture("photo.png", 0, 0, {320, 260});
  const std::vector<std::string> arguments{
      "--input", path("photo.png"),    "--pan", "-1.5,-0.5", "--size",
      "200x180", "--frames",           "12",    "--settle",  "2",
      "--set",   "painting.style=none"};
  std::vector<std::string> gated = arguments;
  gated.emplace_back("--gates");
  expectRefused(gated, AllOf(HasSubstr("--gates"), HasSubstr("the style none has no gates"),
                             HasSubstr("watercolor, painterly")));
  gated[gated.size() - 2] = "painting.style=watercolor";
  gated.insert(gated.end(), {"--json", path("r.json")});
  const ProgramRun run = measured(gated);
  const auto json = nlohmann::json::parse(read("r.json"));
  EXPECT_EQ(run.status, json["gates_passed"] == true ? 0 : 1) << run.error;
  EXPECT_FALSE(json["gates"].empty());
}

TEST_F(Measure, FailsWhereTheControlsAreWrong) {
  std::filesystem::create_directory(path("in"));
  hal::Image flat({.pixelFormat = hal::PixelFormat::kRgb8, .size = kSize, .encoding = {}});
  for (int i = 0; i < 4; ++i) {
    hal::orThrow(hal::writePng(path("in/" + std::to_string(i) + ".png"), flat.view()));
  }
  write("in/motion.json", R"({"v": [0, 0]})");
  const ProgramRun run = measured({"--input", path("in"), "--style", "none", "--noise", "0"});
  EXPECT_EQ(run.status, 2);
  EXPECT_THAT(run.error, HasSubstr("negative control"));
  EXPECT_THAT(run.out, AllOf(HasSubstr("WRONG"), HasSubstr("too smooth")));
}

/// A violet bar crosses a wall of squares; the recording goes on for over a second after that.
TEST_F(Measure, JudgesMoversBeforeAStandingCamera) {
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

TEST_F(Measure, DoesNotLookForMoversUnlessTheCameraStands) {
  writeVisit();
  const ProgramRun run =
      measured({"--input", path("in"), "--style", "none", "--json", path("r.json")});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, testing::Not(HasSubstr("movers cover")));
  EXPECT_EQ(nlohmann::json::parse(read("r.json"))["movers"], nullptr);
}

/// If a pan is measured with --standing, everything is a mover, and nothing is left to compare.
TEST_F(Measure, ACameraThatDoesNotStandLeavesMoversUnjudged) {
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

TEST_F(Measure, SaysWhatCannotBeHadWithoutTruth) {
  writePan(4);
  std::filesystem::remove(path("in/motion.json"));
  const ProgramRun run = measured({"--input", path("in"), "--style", "none"});
  EXPECT_EQ(run.status, 0) << run.error;
  EXPECT_THAT(run.out, AllOf(HasSubstr("Left out"), HasSubstr("motion.json")));
}

TEST_F(Measure, RefusesBrokenTruthInALine) {
  writePan(4);
  write("in/motion.json", R"({"velocity": [1, 2]})");
  expectRefused({"--input", path("in"), "--style", "none"},
                AllOf(HasSubstr("motion.json"), HasSubstr("\"velocity\": unknown key"),
                      HasSubstr("[vx, vy]")));
  std::filesystem::remove(path("in/motion.json"));
  for (int i = 0; i < 3; ++i) write("in/flow_" + std::to_string(i) + ".png", "no flow");
  expectRefused({"--input", path("in"), "--style", "none"}, HasSubstr("flow_"));
  std::filesystem::remove(path("in/flow_2.png"));
  expectRefused({"--input", path("in"), "--style", "none"}, HasSubstr("2 flow files"));
  for (int i = 0; i < 3; ++i)
    constantFlow(20, 10, 1, 1).write(path("in/flow_" + std::to_string(i) + ".png"));
  expectRefused({"--input", path("in"), "--style", "none"}, HasSubstr("20x10"));
  expectRefused({"--input", path("absent"), "--style", "none"}, HasSubstr("absent"));
}

TEST_F(Measure, RefusesFramesThatDoNotFit) {
  writePan(4);
  writePicture("in/9.png", 0, 0, {210, 180});
  expectRefused({"--input", path("in"), "--style", "none"},
                AllOf(HasSubstr("9.png"), HasSubstr("210x180")));
  std::filesystem::remove(path("in/9.png"));
  expectRefused({"--input", path("in"), "--style", "none", "--size", "100x90"},
                HasSubstr("200x180"));
  expectRefused({"--input", path("in"), "--style", "none", "--frames", "2"},
                HasSubstr("3 at least"));
  expectRefused({"--input", path("in"), "--style", "none", "--settle", "50"},
                HasSubstr("0 frames"));
}

TEST_F(Measure, RefusesOptionsThatMakeNoSense) {
  writePan(4);
  expectRefused({"--input", path("in"), "--pan", "1,1"},
                HasSubstr("is a folder, and --pan moves one photograph"));
  writeMedia(path("in.mkv"), 4);
  expectRefused({"--input", path("in.mkv"), "--still"},
                AllOf(HasSubstr("in.mkv"), HasSubstr("--still moves one photograph"),
                      HasSubstr("leave --still out")));
  for (const std::vector<std::string>& camera :
       {std::vector<std::string>{}, {"--camera", "synthetic"}}) {
    std::vector<std::string> arguments{"--zoom", "1%"};
    arguments.insert(arguments.end(), camera.begin(), camera.end());
    expectRefused(arguments, HasSubstr("--zoom: moves a photograph, but --input is missing"));
  }
  expectRefused({"--size", "320x240", "--set", "camera.size=200x180"},
                AllOf(HasSubstr("200x180"), HasSubstr("leave one of the two sizes out")));
  expectRefused({"--input", path("in.mkv"), "--standing", "--motion", path("in/motion.json")},
                HasSubstr("--standing"));
  expectRefused({"--input", path("in/0.png"), "--standing", "--still"}, HasSubstr("--standing"));
  for (const char* pan : {"1", "a,b", "1,2,3", "100,0", "nan,0", ","}) {
    expectRefused({"--input", path("in/0.png"), "--pan", pan}, HasSubstr("--pan"));
  }
  expectRefused({"--input", path("in/0.png"), "--still", "--standing"}, HasSubstr("--standing"));
  expectRefused({"--input", path("in/0.png"), "--zoom", "50%"}, HasSubstr("--zoom"));
  expectRefused({"--input", path("in/0.png"), "--roll", "x"}, HasSubstr("--roll"));
  expectRefused({"--input", path("in/0.png"), "--still", "--noise", "-1"}, HasSubstr("--noise"));
  expectRefused({"--input", path("in/0.png"), "--still", "--settle", "1.5"}, HasSubstr("--settle"));
  expectRefused({"--input", path("in"), "--style", "oil"}, HasSubstr("oil"));
  expectRefused({"--input", path("in"), "--json", path("in/motion.json")}, HasSubstr("--input"));
  expectRefused({"--input", path("in"), "--html", path("absent/r.html")}, HasSubstr("absent"));
  expectRefused({"--camera", "v4l2"}, HasSubstr("--input"));
}

}  // namespace
}  // namespace pleinair::support
