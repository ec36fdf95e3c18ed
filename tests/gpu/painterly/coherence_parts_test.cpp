// Each part of the painterly style's coherence improves its own measure over that without it.
#include "tests/reports/painter/coherence_parts.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include <gmock/gmock.h>

#include "hal/media/png_file.h"
#include "tests/support/gl_test.h"
#include "tests/support/temporary_folder.h"

namespace pleinair {
namespace {

using measure::Measures;
using measure::Subject;

constexpr hal::FrameSize kSize{320, 240};  // SCR of less says little
constexpr MeasuredLength kShort{.frames = 13, .settle = 15, .stillFrames = 5, .stillSettle = 12};

/// Round and square things of all sizes, each with a texture of its own: something to follow, and
/// detail here and there.
hal::Image stillLife(hal::FrameSize size) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgb8, .size = size});
  std::mt19937 random(7);
  const auto upTo = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  for (auto& byte : image.plane(0)) byte = 120;
  for (int i = 0; i < 140; ++i) {
    const int x0 = upTo(size.width);
    const int y0 = upTo(size.height);
    const int half = 5 + upTo(40);
    const bool isRound = upTo(2) == 0;
    const double pitch = 0.2 + 0.01 * upTo(80);
    const double angle = 0.1 * upTo(32);
    const double colour[3] = {40.0 + upTo(170), 40.0 + upTo(170), 40.0 + upTo(170)};
    const double contrast = upTo(30);
    for (int y = std::max(0, y0 - half); y < std::min(size.height, y0 + half); ++y) {
      for (int x = std::max(0, x0 - half); x < std::min(size.width, x0 + half); ++x) {
        if (isRound && std::hypot(x - x0, y - y0) > half) continue;
        const double wave =
            contrast * std::sin(pitch * (x * std::cos(angle) + y * std::sin(angle)));
        for (std::size_t c = 0; c < 3; ++c) {
          image.row(0, y)[static_cast<std::size_t>(x) * 3 + c] =
              static_cast<std::uint8_t>(std::lround(std::clamp(colour[c] + wave, 0.0, 255.0)));
        }
      }
    }
  }
  return image;
}

const CoherenceVariant& variant(std::string_view parameter, std::string_view value) {
  return *std::ranges::find_if(coherenceVariants(), [&](const CoherenceVariant& each) {
    return each.parameter == parameter && each.value == value;
  });
}

class CoherencePartsTest : public support::GlTest {
 protected:
  static std::unique_ptr<CoherenceParts> under(const measure::PhotographMotion& motion) {
    const auto folder = std::make_shared<support::TemporaryFolder>();
    const std::filesystem::path path = folder->path() / "still_life.png";
    hal::orThrow(hal::writePng(path, stillLife({448, 336}).view()));
    return std::make_unique<CoherenceParts>(
        [=] {
          return hal::orThrow(measure::openPhotograph(
              folder->path() / "still_life.png",
              {.size = kSize, .motion = motion, .frames = kShort.settle + kShort.frames}));
        },
        kShort);
  }
  static Measures of(const measure::Report& report) { return report.measures[Subject::kPainting]; }
};

TEST_F(CoherencePartsTest, WithoutItEachPartsOwnMeasureIsWorse) {
  const auto parts = under({.pan = {-1.5, -0.5}});
  const measure::Report full = parts->measured(variant("", ""));
  ASSERT_TRUE(full.areControlsValid());
  EXPECT_LT(*of(full).nHw2, 0.10);
  EXPECT_LT(*of(full).xFlk, 0.5);

  const measure::Report noWarp = parts->measured(variant("warp", "false"));
  EXPECT_GT(*of(noWarp).nHw2, 0.3) << "marks have little to do with what they were";
  EXPECT_GT(*of(noWarp).scr, *of(full).scr + 0.07) << "the shower door";
  EXPECT_LT(*of(noWarp).s10Percent, *of(full).s10Percent - 20.0);

  const measure::Report noHistory = parts->measured(variant("history", "false"));
  EXPECT_GT(*of(noHistory).xFlk, 4.0 * *of(full).xFlk) << "sensor noise is seen";
  EXPECT_GT(*of(noHistory).ew2, 2.0 * *of(full).ew2);

  const measure::Report noHysteresis = parts->measured(variant("hysteresis", "false"));
  EXPECT_GT(noHysteresis.inside->innerTurnoverPercent,
            4.0 * full.inside->innerTurnoverPercent + 1.0);
  EXPECT_GT(*of(noHysteresis).ew2, 1.2 * *of(full).ew2);

  const measure::Report redrawn = parts->measured(variant("coherence", "0"));
  EXPECT_GT(*of(redrawn).xFlk, 10.0 * *of(full).xFlk);
  EXPECT_GT(redrawn.insideStill->innerTurnoverPercent, 100.0);
  EXPECT_EQ(full.insideStill->innerTurnoverPercent, 0.0);
}

/// Moving in, new strokes come all the time: at once, they pop.
TEST_F(CoherencePartsTest, WithoutFadesMorePixelsPop) {
  const auto parts = under({.zoomPercent = 1.0});
  const measure::Report full = parts->measured(variant("", ""));
  const measure::Report noFades = parts->measured(variant("fades", "false"));
  EXPECT_GT(full.inside->births, 1.0);
  EXPECT_GT(*of(noFades).popPercent, 1.05 * *of(full).popPercent);
  EXPECT_GT(*of(noFades).ew2, 1.1 * *of(full).ew2);
}

}  // namespace
}  // namespace pleinair
