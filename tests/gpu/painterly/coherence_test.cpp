// The dial of coherence and its parts: the times that they scale, and the strokes that result.
#include "pipeline/styles/painterly/coherence.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/stroke_fixture.h"
#include "tests/gpu/painterly/painterly_fixture.h"

namespace pleinair::styles {
namespace {

marks::StrokeRule held(const PainterlyParameters& p) {
  marks::StrokeRule rule;
  holdOn(rule, p, 2.0);
  return rule;
}

TEST(CoherenceDial, InTheMiddleIsTheThesiss) {
  const PainterlyParameters p{.coherence = 0.5};
  // 0.95 on the past, 30 times a second.
  EXPECT_NEAR(std::exp(-1.0 / 30.0 / hal::toSeconds(held(p).shapeMemory)), 0.95, 0.0005);
  EXPECT_EQ(held(p).colourMemory, held(p).shapeMemory);
  EXPECT_NEAR(hal::toSeconds(held(p).appearing), 0.3, 1e-6);
  EXPECT_NEAR(hal::toSeconds(anchorHoldOf(p).fadeIn), 0.3, 1e-6);
  EXPECT_NEAR(hal::toSeconds(anchorHoldOf(p).fadeOut), 0.2, 1e-6);
  EXPECT_NEAR(hal::toSeconds(fieldOf(p).memory), 0.4, 1e-6);
}

/// Thesis figure 40: weights of 0.05 and of 0.95 on the past.
TEST(CoherenceDial, MemoryIsTheTimeConstantOfTheHistory) {
  const PainterlyParameters little{.memorySeconds = 0.0111};
  EXPECT_NEAR(std::exp(-1.0 / 30.0 / hal::toSeconds(held(little).shapeMemory)), 0.05, 0.001);
  EXPECT_EQ(held(little).colourMemory, held(little).shapeMemory);
  EXPECT_NEAR(hal::toSeconds(fieldOf(little).memory), 0.4 * 0.0111 / 0.65, 1e-6);
  EXPECT_LT(held(little).flatHold, 3.0F);
  EXPECT_GT(held(little).maxColourPerSecond, 50.0F);
  EXPECT_EQ(held(little).appearing, held({}).appearing) << "of the history alone";
  EXPECT_NEAR(hal::toSeconds(held({.memorySeconds = 2.0}).shapeMemory), 2.0, 1e-6);
  EXPECT_EQ(held({.memorySeconds = 2.0}).flatHold, held({}).flatHold);
}

TEST(CoherenceDial, AtItsEndsNothingAndAllIsHeld) {
  const PainterlyParameters none{.coherence = 0.0};
  EXPECT_EQ(held(none).shapeMemory, hal::Duration(0));
  EXPECT_EQ(held(none).appearing, hal::Duration(0));
  EXPECT_EQ(anchorHoldOf(none).fadeIn, hal::Duration(0));
  EXPECT_EQ(anchorHoldOf(none).fadeOut, hal::Duration(0));
  EXPECT_EQ(fieldOf(none).memory, hal::Duration(0));
  const PainterlyParameters all{.coherence = 1.0};
  EXPECT_GT(held(all).shapeMemory, std::chrono::hours(24));
  EXPECT_GT(held(all).vanishing, std::chrono::hours(24));
  EXPECT_LT(held(all).maxColourPerSecond, 1e-4F);
  EXPECT_LT(anchorHoldOf(all).fadeIn, std::chrono::seconds(2)) << "new strokes are to be seen";
  double before = -1.0;
  for (const double coherence : {0.0, 0.1, 0.4, 0.5, 0.7, 0.95, 1.0}) {
    const double hold = holdOf({.coherence = coherence});
    EXPECT_GT(hold, before);
    before = hold;
  }
}

TEST(CoherenceDial, EachPartSwitchesOffItsOwn) {
  const PainterlyParameters all;
  const auto describe = [](const PainterlyParameters& p) {
    const marks::StrokeRule rule = held(p);
    return std::array<bool, 9>{motionOf(p).follows,
                               fieldOf(p).memory > hal::Duration(0),
                               rule.shapeMemory > hal::Duration(0),
                               rule.colourMemory > hal::Duration(0),
                               fieldOf(p).slack > 0.0,
                               rule.slack > 0.0F,
                               anchorHoldOf(p).hasSlack,
                               rule.appearing > hal::Duration(0),
                               anchorHoldOf(p).fadeIn > hal::Duration(0)};
  };
  using Parts = std::array<bool, 9>;
  EXPECT_EQ(describe(all), (Parts{true, true, true, true, true, true, true, true, true}));
  EXPECT_EQ(describe({.warp = false}),
            (Parts{false, true, true, true, true, true, true, true, true}));
  EXPECT_EQ(describe({.history = false}),
            (Parts{true, false, false, false, true, true, true, true, true}));
  EXPECT_EQ(describe({.hysteresis = false}),
            (Parts{true, true, true, true, false, false, false, true, true}));
  EXPECT_EQ(describe({.fades = false}),
            (Parts{true, true, true, true, true, true, true, false, false}));
}

class Coherence : public PainterlyTest {
 protected:
  static hal::Image plain(std::uint8_t level) {
    hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = kSize});
    for (auto& byte : image.plane(0)) byte = level;
    for (std::size_t i = 3; i < image.plane(0).size(); i += 4) image.plane(0)[i] = 255;
    return image;
  }
  /// By their anchors' seeds, of the finest layer.
  static std::map<std::uint32_t, marks::StrokeSlot> strokesOf(const Painterly& style) {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    const Painterly::PaintedLayer layer = style.layer(style.layerCount() - 1);
    const auto strokes = support::readBuffer<marks::StrokeSlot>(layer.strokes.strokes());
    const std::vector<marks::Anchor> anchors = layer.anchors.read();
    std::map<std::uint32_t, marks::StrokeSlot> found;
    for (std::size_t i = 0; i < anchors.size(); ++i) {
      if (anchors[i].isAlive()) found.emplace(anchors[i].seed, strokes[i]);
    }
    return found;
  }
};

/// When the picture turns dark, α of the past is left after each frame of 1/30 s.
TEST_F(Coherence, ColoursAreBlendedAsTheThesisDoes) {
  for (const auto& [parameter, value, weight] : {std::tuple("coherence", "0.5", 0.95),
                                                 {"history", "false", 0.0},
                                                 {"memory", "0.0111", 0.05}}) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with(parameter, value));
    const auto show = [&](std::uint8_t level) {
      scene::ArFrame frame = next(plain(level));
      frame.captureTime = hal::TimePoint(hal::Duration(33'333'333) * number_);
      style.paint(frame, "");
    };
    show(132);
    constexpr int kFrames = 12;
    for (int i = 0; i < kFrames; ++i) show(120);
    const double expected = (120.0 + 12.0 * std::pow(weight, kFrames)) / 255.0;
    const auto strokes = strokesOf(style);
    EXPECT_GT(strokes.size(), 100U);
    for (const auto& [seed, stroke] : strokes) EXPECT_NEAR(stroke.colour.g, expected, 0.004);
  }
}

/// A change that is too large for noise and for the exposure shows other content: the stroke keeps
/// nothing of its past.
TEST_F(Coherence, ALargeChangeIsFollowedAtOnce) {
  Painterly style(library_);
  style.paint(next(plain(200)), "");
  style.paint(next(plain(120)), "");
  const auto strokes = strokesOf(style);
  EXPECT_GT(strokes.size(), 100U);
  for (const auto& [seed, stroke] : strokes) EXPECT_NEAR(stroke.colour.g, 120.0 / 255.0, 0.004);
}

/// Strokes keep colour and shape as long as they live, whatever the picture does.
TEST_F(Coherence, AtOneStrokesNeverLetGo) {
  Painterly style(library_);
  style.setParameters(style.parameters().with("coherence", "1"));
  paint(style, next(0.0, 0.0));
  const auto first = strokesOf(style);
  for (int i = 1; i <= 10; ++i) {
    hal::Image dark = testPicture(kSize, static_cast<unsigned>(i), 2.0 * i);
    for (auto& byte : dark.plane(0)) byte = static_cast<std::uint8_t>(byte / 3);
    paint(style, next(dark, 2.0));
  }
  std::size_t living = 0;
  for (const auto& [seed, stroke] : strokesOf(style)) {
    const auto was = first.find(seed);
    if (was == first.end()) continue;
    ++living;
    EXPECT_LT(glm::distance(stroke.colour, was->second.colour), 1e-3F);
    EXPECT_LT(glm::distance(stroke.ahead[0], was->second.ahead[0]), 1e-3F);
    EXPECT_LT(glm::distance(stroke.lengths, was->second.lengths), 1e-3F);
    EXPECT_NEAR(stroke.exists, was->second.exists, 1e-4F);
  }
  EXPECT_GT(living, 200U);
}

TEST_F(Coherence, WithoutWarpStrokesStayOnTheScreen) {
  for (const bool follows : {true, false}) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("warp", follows ? "true" : "false"));
    paint(style, next(0.0, 0.0));
    std::map<std::uint32_t, glm::vec2> before;
    for (const marks::Anchor& each : style.readAnchors()) {
      if (each.isAlive()) before.emplace(each.seed, each.px);
    }
    paint(style, next(2.0, 2.0));
    std::size_t same = 0;
    for (const marks::Anchor& each : style.readAnchors()) {
      const auto was = before.find(each.seed);
      if (!each.isAlive() || was == before.end()) continue;
      ++same;
      EXPECT_NEAR(each.px.x - was->second.x, follows ? -2.0 : 0.0, 1e-3);
    }
    EXPECT_GT(same, 500U);
  }
}

/// The view shows each region in its class's colour, mixed with the picture.
TEST_F(Coherence, RegionsKeepTheirClassesUnderNoise) {
  const auto changesWith = [&](const char* hysteresis) {
    restart();
    Painterly style(library_);
    // Without history it is hysteresis alone that holds.
    style.setParameters(style.parameters().with("hysteresis", hysteresis).with("history", "false"));
    std::vector<std::uint8_t> before;
    int changes = 0;
    for (int i = 0; i < 40; ++i) {
      const std::vector<std::uint8_t> now = paint(style, next(0.0, 0.0), "regions");
      // Classes' colours are farther apart than noise can be.
      for (std::size_t at = 0; i > 25 && at < now.size(); ++at) {
        changes += std::abs(int{now[at]} - int{before[at]}) > 30 ? 1 : 0;
      }
      before = now;
    }
    return changes;
  };
  const int without = changesWith("false");
  const int with = changesWith("true");
  RecordProperty("changes", std::to_string(with) + " of " + std::to_string(without));
  EXPECT_GT(without, 50) << "the control";
  EXPECT_LE(with, without / 10);
}

TEST_F(Coherence, WithoutFadesStrokesAreThereOrNot) {
  for (const bool fades : {true, false}) {
    restart();
    Painterly style(library_);
    style.setParameters(style.parameters().with("fades", fades ? "true" : "false"));
    int between = 0;
    int born = 0;
    for (int i = 0; i < 12; ++i) {
      paint(style, next(3.3 * i, 3.3));
      for (const marks::Anchor& each : style.readAnchors()) {
        if (!each.isAlive()) continue;
        between += each.fade > 0.0F && each.fade < 1.0F ? 1 : 0;
        born += i > 0 && each.isBorn() ? 1 : 0;
      }
    }
    EXPECT_GT(born, 50);
    if (fades) {
      EXPECT_GT(between, 20) << "the control";
    } else {
      EXPECT_EQ(between, 0);
    }
  }
}

}  // namespace
}  // namespace pleinair::styles
