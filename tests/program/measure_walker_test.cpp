// `pleinair measure --walker`: a cut-out walks past a photograph.
#include <cmath>

#include <nlohmann/json.hpp>

#include "tests/program/measure_fixture.h"

namespace pleinair::support {
namespace {

using testing::HasSubstr;

class MeasureWalker : public Measure {
 protected:
  /// Waves of soft light and shade.
  void writeWall() {
    constexpr hal::FrameSize kWall{320, 240};
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = kWall, .encoding = {}});
    for (int y = 0; y < kWall.height; ++y) {
      for (int x = 0; x < kWall.width; ++x) {
        auto* const pixel = image.row(0, y).data() + static_cast<std::ptrdiff_t>(3) * x;
        for (int c = 0; c < 3; ++c) {
          const double wave = std::sin(0.11 * x + 0.04 * y + c) * std::cos(0.09 * y - 0.03 * x);
          pixel[c] = static_cast<std::uint8_t>(150 + 60 * wave);
        }
      }
    }
    hal::orThrow(hal::writePng(path("wall.png"), image.view()));
  }

  /// Someone in a striped coat with a light face that has dark eyes, in a transparent picture.
  void writePerson() {
    constexpr hal::FrameSize kPerson{120, 240};
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kPerson, .encoding = {}});
    for (int y = 0; y < kPerson.height; ++y) {
      for (int x = 0; x < kPerson.width; ++x) {
        const bool isHead = std::hypot(x - 60.0, y - 50.0) < 40.0;
        const bool isEye = std::hypot(std::abs(x - 60.0) - 15.0, y - 45.0) < 5.0;
        const bool isCoat = y > 90 && std::abs(x - 60) < 55;
        const int level = isEye ? 40 : isHead ? 210 : 90 + 40 * (y / 50 % 2);
        auto* const pixel = image.row(0, y).data() + static_cast<std::ptrdiff_t>(4) * x;
        pixel[0] = static_cast<std::uint8_t>(level);
        pixel[1] = static_cast<std::uint8_t>(level * 8 / 10);
        pixel[2] = static_cast<std::uint8_t>(level * 6 / 10);
        pixel[3] = isHead || isCoat ? 255 : 0;
      }
    }
    hal::orThrow(hal::writePng(path("person.png"), image.view()));
  }
};

TEST_F(MeasureWalker, KnowsItsMasksAndMotion) {
  writeWall();
  writePerson();
  const ProgramRun run =
      measured({"--input", path("wall.png"), "--walker", path("person.png"), "--walker-speed",
                "120", "--settle", "8", "--set", "camera.rate=15", "--style", "painterly", "--json",
                path("r.json")});
  ASSERT_EQ(run.status, 0) << run.error << run.out;
  EXPECT_THAT(run.out, HasSubstr("past which"));
  EXPECT_THAT(run.out, HasSubstr("the true masks of movers"));
  const auto json = nlohmann::json::parse(read("r.json"));
  EXPECT_EQ(json["movers"]["masks"], "true");
  EXPECT_EQ(json["controls_valid"], true) << json["controls"];
  EXPECT_LT(json["movers"]["along_motion"]["input"]["mover_pop_percent"], 0.5);
  EXPECT_GT(json["labels"]["iou_mean"], 0.9);
  // RETURN is not judged: after a second, strokes of so soft a wall still find their directions.
  for (const auto& gate : json["gates"]) {
    const std::string what = gate["what"];
    for (const char* const name : {"MOVER POP", "SEAM POP", "LOST", "GHOST", "STILL"}) {
      if (!what.starts_with(name)) continue;
      EXPECT_EQ(gate["verdict"], "pass") << gate;
    }
  }
}

TEST_F(MeasureWalker, IsRefusedWhereThereIsNothingToSee) {
  writePicture("wall.png", 0, 0);
  const hal::Image nothing(
      {.pixelFormat = hal::PixelFormat::kRgba8, .size = {16, 16}, .encoding = {}});
  hal::orThrow(hal::writePng(path("nothing.png"), nothing.view()));
  expectRefused({"--walker", path("nothing.png")}, HasSubstr("--input"));
  expectRefused({"--input", path("wall.png"), "--walker", path("nothing.png")},
                HasSubstr("transparent all over"));
  expectRefused({"--input", path("wall.png"), "--walker", path("wall.png"), "--pan", "1,0"},
                HasSubstr("--pan"));
}

}  // namespace
}  // namespace pleinair::support
