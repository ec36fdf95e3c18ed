// People who are there when the camera begins to look and move where they stand: their plain parts
// look as what is remembered there, but belong to them.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/motion_layers_fixture.h"

namespace pleinair::marks {
namespace {

class InPlaceMoversTest : public MotionLayersTest {
 protected:
  static constexpr double kRadius = 50.0;

  /// Somebody who sways by 6 px to and fro, within 3 s.
  static glm::dvec2 swayingAt(int frame) {
    const double turns = frame / 90.0;
    return glm::dvec2(160.0, 120.0) +
           glm::dvec2(5.0, 3.3) * std::sin(2.0 * std::numbers::pi * turns);
  }

  /// A face: a disc with eyes, a nose and a mouth.
  static hal::Image face(glm::dvec2 at, unsigned seed) {
    hal::Image image = seen({.disc = at, .radius = kRadius}, kSize, seed);
    for (const auto& [place, half] : {std::pair(glm::dvec2(-18, -14), glm::dvec2(8, 4)),
                                      std::pair(glm::dvec2(18, -14), glm::dvec2(8, 4)),
                                      std::pair(glm::dvec2(0, 4), glm::dvec2(4, 8)),
                                      std::pair(glm::dvec2(0, 26), glm::dvec2(14, 4))}) {
      const glm::dvec2 first = at + place - half;
      const glm::dvec2 last = at + place + half;
      for (int y = static_cast<int>(first.y); y < static_cast<int>(last.y); ++y) {
        for (int x = static_cast<int>(first.x); x < static_cast<int>(last.x); ++x) {
          std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
          for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(p[c] / 2);
        }
      }
    }
    return image;
  }

  /// `knowsFlow`: else it says that nothing moves, as flow does of a small motion.
  void sway(int frames, bool knowsFlow) {
    for (unsigned i = 0; i < 8; ++i) seeImage(face(swayingAt(0), i));
    for (int i = 1; i <= frames; ++i) {
      disc_ = swayingAt(i);
      const hal::Image image = face(disc_, 20 + static_cast<unsigned>(i));
      if (knowsFlow) {
        const View view{.disc = disc_, .radius = kRadius};
        seeDiscMoved(image, view, disc_ - swayingAt(i - 1), Texture::kWhole);
      } else {
        seeImage(image);
      }
    }
  }

  /// The share of the cells amid the features that is labelled.
  double labelledInside() const {
    const Overlap inner = overlapWith({.disc = disc_ + glm::dvec2(0.0, 4.0), .radius = 22.0});
    return static_cast<double>(inner.both) / inner.wanted;
  }
  /// The cells labelled 8 px or more beside it, as a share of the disc's.
  double labelledOutside() const {
    const Overlap outer = overlapWith({.disc = disc_, .radius = kRadius + 8.0});
    return static_cast<double>(outer.found - outer.both) / outer.wanted;
  }

  /// A wall without edges, before which the disc goes.
  hal::Image beforePlainWall(const View& view, unsigned seed) {
    hal::Image image = seen(view, kSize, seed);
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        if (glm::distance(glm::dvec2(x, y), view.disc) < view.radius) continue;
        std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        const int trembles =
            static_cast<int>(seed * 7919U + static_cast<unsigned>(31 * y + 17 * x)) % 5;
        for (int c = 0; c < 3; ++c) p[c] = static_cast<std::uint8_t>(150 + trembles);
      }
    }
    return image;
  }

  glm::dvec2 disc_{0.0};
};

TEST_F(InPlaceMoversTest, AFaceThatSwaysIsFilled) {
  sway(60, true);
  EXPECT_GT(labelledInside(), 0.5) << "0.68";
  EXPECT_LT(labelledOutside(), 0.03);
}

TEST_F(InPlaceMoversTest, TheControlIsOutlines) {
  sway(60, false);
  EXPECT_LT(labelledInside(), 0.2) << "0.05: what only differs is no more than the outlines";
}

TEST_F(InPlaceMoversTest, SomebodyWhoRestsIsBackground) {
  for (unsigned i = 0; i < 60; ++i) seeImage(face(swayingAt(0), i));
  EXPECT_EQ(movers(), 0);
}

/// 20 s of frames 0.1 s apart: its plain parts do not change, but they do not rest.
TEST_F(InPlaceMoversTest, AFaceIsFilledForAsLongAsItSways) {
  sway(8, true);
  double least = 1.0;
  for (int i = 9; i < 208; ++i) {
    time_ += std::chrono::milliseconds(100) - kStep;
    disc_ = swayingAt(3 * i);
    const View view{.disc = disc_, .radius = kRadius};
    seeDiscMoved(face(disc_, 300 + static_cast<unsigned>(i)), view, disc_ - swayingAt(3 * (i - 1)),
                 Texture::kWhole);
    if (i > 30) least = std::min(least, labelledInside());
  }
  EXPECT_GT(least, 0.4);
}

/// A nudge of the camera loses nothing.
TEST_F(InPlaceMoversTest, AFaceStaysFilledAfterANudge) {
  sway(60, true);
  seeImage(face(disc_, 500), glm::dvec2(0.5, 0.0));
  const View view{.disc = disc_, .radius = kRadius};
  seeDiscMoved(face(disc_, 501), view, glm::dvec2(0.0), Texture::kWhole);
  seeDiscMoved(face(disc_, 502), view, glm::dvec2(0.0), Texture::kWhole);
  EXPECT_GT(labelledInside(), 0.4);
}

/// Flow reaches beyond who walks past, over the plain wall.
TEST_F(InPlaceMoversTest, TheWallBesideWalkersIsNone) {
  for (unsigned i = 0; i < 12; ++i) seeImage(beforePlainWall({}, i));
  for (const unsigned walker : {1U, 2U}) {
    for (int i = 0; i < 40; ++i) {
      disc_ = {60.0 + 5.0 * i, 120.0};
      const View view{.disc = disc_, .radius = 40.0};
      seeDiscMoved(beforePlainWall(view, 50 * walker + static_cast<unsigned>(i)), view, {5.0, 0.0},
                   Texture::kWhole);
      if (i < 5) continue;
      EXPECT_GT(overlapWith(view).iou(), 0.85) << walker << ", " << i;
    }
    for (unsigned i = 0; i < 200; ++i) seeImage(beforePlainWall({}, 200 + i));
  }
}

}  // namespace
}  // namespace pleinair::marks
