// What moves before things that are nearly of its own colour is a mover there, too.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/motion_layers_fixture.h"

namespace pleinair::marks {
namespace {

/// A disc before a wall with things of nearly the disc's colour: less than what makes a place other
/// content by itself.
class SlightMoversTest : public MotionLayersTest {
 protected:
  using Region = std::function<bool(glm::dvec2)>;

  static constexpr int kSlightly = 10;  // levels of blue

  hal::Image picture(const View& view, const Region& isLikeDisc) {
    hal::Image image = seen(view, kSize, ++noise_);
    const hal::Image like = seen({.disc = {160.0, 120.0}, .radius = 400.0}, kSize, noise_);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const glm::dvec2 px(x, y);
        if (!isLikeDisc(px) || glm::distance(px, view.disc) < view.radius) continue;
        std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        std::copy_n(like.view().planes[0].bytes.data() + 4 * (std::ptrdiff_t{y} * kSize.width + x),
                    4, p);
        p[2] = static_cast<std::uint8_t>(p[2] + kSlightly);
      }
    }
    return image;
  }

  void learn(const Region& isLikeDisc) {
    for (int i = 0; i < 12; ++i) seeImage(picture({}, isLikeDisc));
  }

  /// The share of the cells of the disc that are labelled, of those in the region and 4 px within
  /// the disc.
  double labelledShare(const View& view, const Region& isLikeDisc) const {
    const std::vector<glm::vec4> labels = texelsOf(layers_->labels());
    const int width = layers_->labels().size().width;
    int labelled = 0;
    int cells = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto index = static_cast<int>(i);
      const glm::dvec2 px = (glm::dvec2(index % width, index / width) + 0.5) * 2.0;
      if (!isLikeDisc(px) || glm::distance(px, view.disc) > view.radius - 4.0) continue;
      ++cells;
      labelled += labels[i].r > 0.5F ? 1 : 0;
    }
    EXPECT_GT(cells, 100);
    return labelled / std::max(1.0, static_cast<double>(cells));
  }

  /// Labelled cells farther from the disc than flow reaches.
  int strayCells(const View& view) const {
    constexpr double kReach = 20.0;
    const std::vector<glm::vec4> labels = texelsOf(layers_->labels());
    const int width = layers_->labels().size().width;
    int stray = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      const auto index = static_cast<int>(i);
      const glm::dvec2 px = (glm::dvec2(index % width, index / width) + 0.5) * 2.0;
      const bool isFar = glm::distance(px, view.disc) > view.radius + kReach;
      stray += isFar && labels[i].r > 0.5F ? 1 : 0;
    }
    return stray;
  }

 private:
  unsigned noise_ = 0;
};

/// Its flow is known at its outline only. The region reaches beyond it, so that it is no hole.
TEST_F(SlightMoversTest, APlainPartIsCarriedOverThingsLikeIt) {
  const Region below = [](glm::dvec2 px) { return px.y > 122.0 && px.x > 130.0; };
  learn(below);
  View view{.radius = 45.0};
  for (int i = 0; i < 16; ++i) {
    view.disc = {70.0 + 6.0 * i, 120.0};
    seeDiscMoved(picture(view, below), view, {6.0, 0.0}, Texture::kOutline);
    if (i < 9) continue;
    EXPECT_GT(labelledShare(view, below), 0.6) << i;
  }
}

TEST_F(SlightMoversTest, APartThatRestsBeforeThingsLikeItStaysAMover) {
  const Region below = [](glm::dvec2 px) { return px.y > 122.0 && px.x > 130.0; };
  learn(below);
  View view{.radius = 45.0};
  for (int i = 0; i < 16; ++i) {
    view.disc = {70.0 + 6.0 * i, 120.0};
    seeDiscMoved(picture(view, below), view, {6.0, 0.0}, Texture::kOutline);
  }
  for (int i = 0; i < 12; ++i) seeImage(picture(view, below), panning(0.0, 0.0));
  EXPECT_GT(labelledShare(view, below), 0.25) << "after 0.4 s";
}

TEST_F(SlightMoversTest, WhatComesInBeforeThingsLikeItIsAMover) {
  const Region atBorder = [](glm::dvec2 px) { return px.x < 60.0 && px.y > 122.0; };
  learn(atBorder);
  View view{.radius = 60.0};
  for (int i = 0; i < 9; ++i) {
    view.disc = {-50.0 + 8.0 * i, 120.0};
    seeDiscMoved(picture(view, atBorder), view, {8.0, 0.0}, Texture::kOutline);
    if (i < 5) continue;
    EXPECT_GT(labelledShare(view, atBorder), 0.25) << i;
  }
}

/// Rows of cells that are like the disc alternate with rows that are not.
TEST_F(SlightMoversTest, AMoverHasNoHolesInRows) {
  const Region rows = [](glm::dvec2 px) {
    return px.x > 130.0 && std::abs(px.y - 120.0) < 24.0 && static_cast<int>(px.y) / 2 % 2 == 0;
  };
  learn(rows);
  View view{.radius = 45.0};
  for (int i = 0; i < 16; ++i) {
    view.disc = {70.0 + 6.0 * i, 120.0};
    seeDiscMoved(picture(view, rows), view, {6.0, 0.0}, Texture::kOutline);
    if (i < 7) continue;
    EXPECT_GT(labelledShare(view, rows), 0.9) << i;
  }
}

/// The wall is darker than the disc on the left and lighter on the right: along a line, both are of
/// one colour.
TEST_F(SlightMoversTest, AMoverHasNoCrackWhereItLooksAsWhatIsBehindIt) {
  constexpr double kLineX = 160.0;
  constexpr double kSlope = 6.0;  // levels a px
  const auto discBeforeRamp = [&](const View& view, double slitPx) {
    hal::Image image = picture(view, [](glm::dvec2) { return false; });
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const double along = x + 0.5 - kLineX;
        const bool isSlit = std::abs(along) < 0.5 * slitPx;
        const bool isDisc = glm::distance(glm::dvec2(x, y), view.disc) < view.radius;
        if (isDisc && !isSlit) continue;
        const glm::dvec3 behind = glm::dvec3(240.0, 120.0, 20.0) + kSlope * along;
        std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        for (int c = 0; c < 3; ++c) {
          // The slit shows the wall, which is dark there, with and without the disc.
          const double level = slitPx > 0.0 && isSlit ? 60.0 : behind[c];
          p[c] = static_cast<std::uint8_t>(std::clamp(level, 0.0, 255.0));
        }
      }
    }
    return image;
  };
  const Region line = [](glm::dvec2 px) { return std::abs(px.x - kLineX) < 2.0; };
  const auto shareOnLine = [&](double slitPx) {
    layers_->reset();
    for (int i = 0; i < 12; ++i) seeImage(discBeforeRamp({}, slitPx));
    View view{.radius = 60.0};
    for (int i = 0; i < 14; ++i) {
      view.disc = {90.0 + 5.0 * i, 120.0};
      seeDiscMoved(discBeforeRamp(view, slitPx), view, {5.0, 0.0}, Texture::kOutline);
    }
    return labelledShare(view, line);
  };
  EXPECT_GT(shareOnLine(0.0), 0.7);
  EXPECT_LT(shareOnLine(6.0), 0.5) << "the control: a slit";
}

/// The control: the place of the same colour beside the disc belongs to no mover.
TEST_F(SlightMoversTest, ThingsLikeTheDiscBesideItAreNoMovers) {
  const Region below = [](glm::dvec2 px) { return px.y > 122.0 && px.x > 130.0; };
  learn(below);
  View view{.radius = 45.0};
  for (int i = 0; i < 30; ++i) {
    view.disc = {70.0 + 6.0 * i, 120.0};
    seeDiscMoved(picture(view, below), view, {6.0, 0.0}, Texture::kOutline);
  }
  EXPECT_LT(strayCells(view), 60);
}

}  // namespace
}  // namespace pleinair::marks
