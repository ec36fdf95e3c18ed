// Leaves in the wind, before a camera that stands: they are no movers, but who passes before them
// is one; and the strokes on them keep their lengths.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "tests/gpu/marks/motion_layers_fixture.h"
#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

constexpr double kStepSeconds = 0.033;
constexpr double kRadius = 30.0;

/// Leaves of 8 px, each of which sways by itself by up to 3 px.
double leaves(glm::dvec2 px, double seconds) {
  constexpr double kLeafPx = 8.0;
  const glm::dvec2 leaf = glm::floor(px / kLeafPx);
  const double own = glm::fract(std::sin(12.9898 * leaf.x + 78.233 * leaf.y) * 43758.5453);
  const glm::dvec2 at =
      px + glm::dvec2(3.0, 1.5) * std::sin(2.0 * std::numbers::pi * (own + (0.7 + own) * seconds));
  return 0.55 + 0.14 * std::sin(0.9 * at.x) * std::cos(0.7 * at.y);
}

class DynamicBackground : public StrokeTest {
 protected:
  void SetUp() override {
    StrokeTest::SetUp();
    if (IsSkipped()) return;
    layers_.emplace(library_, kSize);
  }

  static glm::dvec2 discAt(int frame) { return {-40.0 + 6.0 * frame, 64.0}; }

  /// Leaves, and a darker disc that passes from `withDisc` on, as many frames after it began.
  void see(int withDisc = -1) {
    const double seconds = kStepSeconds * seen_;
    advance(greyPicture(
                kSize,
                [&](glm::dvec2 px) {
                  const bool isDisc =
                      withDisc >= 0 && glm::distance(px, discAt(withDisc)) < kRadius;
                  return isDisc ? 0.3 : leaves(px, seconds);
                },
                2.0, static_cast<unsigned>(seen_)),
            rule_);
    ++seen_;
  }

  /// The share of the cells that `isIn` tells which is labelled.
  template <typename Test>
  double labelled(const Test& isIn) const {
    const std::vector<float> labels = support::readRgba32f(layers_->labels());
    const int width = layers_->labels().size().width;
    double found = 0.0;
    double all = 0.0;
    for (std::size_t i = 0; 4 * i < labels.size(); ++i) {
      const auto cell = static_cast<int>(i);
      const glm::dvec2 px = (glm::dvec2(cell % width, cell / width) + 0.5) *
                            static_cast<double>(MotionLayers::kCellPixels);
      if (!isIn(px)) continue;
      all += 1.0;
      found += labels[4 * i] > 0.5F ? 1.0 : 0.0;
    }
    return found / std::max(all, 1.0);
  }

  StrokeRule rule_;

 private:
  int seen_ = 0;
};

constexpr auto kEverywhere = [](glm::dvec2) { return true; };

TEST_F(DynamicBackground, LeavesAreNoMoversOnceTheyAreKnownToSway) {
  double atFirst = 0.0;
  for (int i = 0; i < 12; ++i) {
    see();
    atFirst = std::max(atFirst, labelled(kEverywhere));
  }
  EXPECT_GT(atFirst, 0.05) << "the control: they differ from what is remembered";
  for (int i = 0; i < 78; ++i) see();
  double later = 0.0;
  for (int i = 0; i < 30; ++i) {
    see();
    later += labelled(kEverywhere) / 30.0;
  }
  EXPECT_LT(later, 0.04) << "0.09 without";
}

TEST_F(DynamicBackground, WhoPassesBeforeThemIsAMover) {
  for (int i = 0; i < 90; ++i) see();
  for (int i = 0; i < 48; ++i) {
    see(i);
    const glm::dvec2 disc = discAt(i);
    if (disc.x < kRadius || disc.x > kSize.width - kRadius) continue;
    const auto isDisc = [&](glm::dvec2 px) { return glm::distance(px, disc) < kRadius - 2.0; };
    EXPECT_GT(labelled(isDisc), 0.9) << i;
    const auto isFar = [&](glm::dvec2 px) { return std::abs(px.x - disc.x) > kRadius + 40.0; };
    EXPECT_LT(labelled(isFar), 0.04) << i;
  }
}

/// Somebody of a colour not far from the wall's, who stands before it and moves in place, is no
/// leaf.
TEST_F(MotionLayersTest, WhoMovesInPlaceStaysAMover) {
  const auto image = [](const View& view, unsigned seed) {
    hal::Image picture = seen({}, kSize, seed);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (glm::distance(glm::dvec2(x, y), view.disc) >= view.radius) continue;
        auto* p = picture.row(0, y).data() + std::ptrdiff_t{4} * x;
        // Some of the wall's places look alike.
        constexpr std::array<std::uint8_t, 3> kColour{165, 110, 90};
        std::ranges::copy(kColour, p);
      }
    }
    return picture;
  };
  const auto placeAt = [](int frame) {
    return glm::dvec2(160.0 + 24.0 * std::sin(0.15 * frame), 120.0);
  };
  for (unsigned i = 0; i < 6; ++i) seeImage(image({}, i));
  double least = 1.0;
  for (int i = 0; i < 240; ++i) {
    const View view{.disc = placeAt(i), .radius = 35.0};
    seeDiscMoved(image(view, 10 + static_cast<unsigned>(i)), view, placeAt(i) - placeAt(i - 1),
                 Texture::kWhole);
    if (i > 180) least = std::min(least, overlapWith(view).iou());
  }
  EXPECT_GT(least, 0.75);
}

TEST_F(DynamicBackground, StrokesKeepTheirLengthsThere) {
  rule_.flatHold = 100.0F;
  /// By how much arms become longer or shorter in a frame, in segments.
  const auto changesIn = [&](int frames) {
    double sum = 0.0;
    double count = 0.0;
    for (int i = 0; i < frames; ++i) {
      const std::vector<Anchor> anchorsBefore = anchors_->read();
      const std::vector<StrokeSlot> before = readStrokes();
      see();
      const std::vector<Anchor> anchors = anchors_->read();
      const std::vector<StrokeSlot> now = readStrokes();
      for (std::size_t slot = 0; slot < now.size(); ++slot) {
        const bool stays = anchorsBefore[slot].isStaying() && anchors[slot].isStaying() &&
                           anchors[slot].seed == anchorsBefore[slot].seed;
        if (!stays) continue;
        sum += glm::distance(now[slot].lengths, before[slot].lengths);
        count += 1.0;
      }
    }
    EXPECT_GT(count, 100.0 * frames);
    return sum / std::max(count, 1.0);
  };
  for (int i = 0; i < 3; ++i) see();
  EXPECT_GT(changesIn(4), 0.02) << "the control: before it is known, ends follow the leaves";
  for (int i = 0; i < 90; ++i) see();
  EXPECT_LT(changesIn(8), 0.005) << "segments";
}

}  // namespace
}  // namespace pleinair::marks
