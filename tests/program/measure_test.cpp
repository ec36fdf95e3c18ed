// `pleinair measure`: its report, its exit status, and one line for whatever is wrong with its
// input.
#include <filesystem>

#include <nlohmann/json.hpp>

#include "tests/program/measure_fixture.h"
#include "tests/support/deep_png.h"
#include "tests/support/media_files.h"

namespace pleinair::support {
namespace {

using testing::AllOf;
using testing::HasSubstr;

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
