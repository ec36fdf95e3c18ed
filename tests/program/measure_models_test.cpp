// `pleinair measure --scene`: models, their truth and its controls.
#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/program/measure_fixture.h"
#include "tests/unit/scene/gltf_builder.h"

namespace pleinair::support {
namespace {

using testing::AllOf;
using testing::HasSubstr;

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

}  // namespace
}  // namespace pleinair::support
