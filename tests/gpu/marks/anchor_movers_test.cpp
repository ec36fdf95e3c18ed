// Anchors on something that walks before a camera that stands, and whose outline swells and
// shrinks with each step.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>

#include <glm/vec2.hpp>
#include <gtest/gtest.h>

#include "pipeline/marks/movers/motion_layers.h"
#include "tests/gpu/marks/anchor_life_fixture.h"

namespace pleinair::marks {
namespace {

struct Walker {
  double x = 0.0;  ///< px, of its middle
  double halfWidth = 20.0;
  static constexpr double kTop = 50.0;
  static constexpr double kBottom = 200.0;
  bool isAt(glm::dvec2 px, double border) const {
    return std::abs(px.x - x) < halfWidth - border && px.y > kTop + border &&
           px.y < kBottom - border;
  }
};

hal::Image imageOf(const std::optional<Walker>& walker, unsigned seed) {
  hal::Image image({.pixelFormat = hal::PixelFormat::kRgba8, .size = {320, 240}});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, 1.5);
  for (int y = 0; y < 240; ++y) {
    std::uint8_t* p = image.row(0, y).data();
    for (int x = 0; x < 320; ++x, p += 4) {
      double luma = 170.0 + 25.0 * std::sin(0.21 * x + 1.3 * std::sin(0.07 * y));
      if (walker && walker->isAt({x, y}, 0.0)) {
        const double across = (x - walker->x) / walker->halfWidth;
        luma = 60.0 + 20.0 * std::sin(7.0 * across) * std::cos(0.2 * y);
      }
      const auto grey = static_cast<std::uint8_t>(std::clamp(luma + noise(random), 0.0, 255.0));
      p[0] = p[1] = p[2] = grey;
      p[3] = 255;
    }
  }
  return image;
}

class AnchorsOfAWalker : public AnchorLife {
 protected:
  /// How many anchors lie in a cell that shows the walker alone: the mean over one walk.
  double densityOf(const AnchorHold& hold) {
    useScene({});
    std::optional<MotionLayers> layers(std::in_place, library_, kSize);
    double sum = 0.0;
    double cells = 0.0;
    for (unsigned i = 0; i < 70; ++i) {
      std::optional<Walker> walker;
      if (i >= 10) {
        const double t = i - 10.0;
        walker = Walker{.x = 60.0 + 2.0 * t, .halfWidth = 28.0 + 14.0 * std::sin(0.15 * t)};
      }
      picture_ = support::textureOf(imageOf(walker, i).view());
      const scene::ArFrame frame = compose(*renderer_, {}, tracking::ImageMotion{});
      field_->update(frame);
      layers->update(frame, *field_);
      set_->advance(frame, *field_, hold, &*layers);
      if (i < 24) continue;
      const double border = 4.0;
      for (const Anchor& each : set_->read()) {
        const bool isMover = each.isStaying() && (each.state & Anchor::kMover) != 0;
        sum += isMover && walker->isAt(glm::dvec2(each.px), border) ? 1.0 : 0.0;
      }
      cells += std::max(0.0, 2.0 * (walker->halfWidth - border)) *
               (Walker::kBottom - Walker::kTop - 2.0 * border) / (kCellPixels * kCellPixels);
    }
    return sum / cells;
  }
};

TEST_F(AnchorsOfAWalker, AreAsDenseAsTheirTargetWithoutSlack) {
  const double target = set_->options().density.target;
  const double tight = densityOf({.hasMoverSlack = false});
  RecordProperty("tight", std::to_string(tight));
  EXPECT_GT(tight, 0.85 * target);
  EXPECT_LT(tight, 1.15 * target);
  // The control: with slack they are too few or too many.
  const double slack = densityOf({});
  RecordProperty("slack", std::to_string(slack));
  EXPECT_GT(std::abs(slack - target), 0.3 * target);
}

}  // namespace
}  // namespace pleinair::marks
