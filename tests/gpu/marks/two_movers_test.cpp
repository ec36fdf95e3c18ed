// Two movers that pass each other remain two: each with its number, its motion and its anchors.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "tests/gpu/marks/motion_layers_fixture.h"

namespace pleinair::marks {
namespace {

/// Two discs before a wall, of which the first is before the second.
class TwoMoversTest : public MotionLayersTest {
 protected:
  static constexpr double kRadius = 34.0;
  static constexpr std::size_t kMovers = 2;

  struct Discs {
    std::array<glm::dvec2, kMovers> at;
    std::array<glm::dvec2, kMovers> steps;
  };

  /// The disc that is seen at a place, kMovers for the wall; both reach farther by `more`.
  static std::size_t discAt(const Discs& discs, glm::dvec2 px, double more = 0.0) {
    for (std::size_t i = 0; i < kMovers; ++i) {
      if (glm::distance(px, discs.at[i]) < kRadius + more) return i;
    }
    return kMovers;
  }

  hal::Image pictureOf(const Discs& discs) {
    hal::Image image = seen({.disc = discs.at[1], .radius = kRadius}, kSize, ++noise_);
    // The nearer one: stripes of two blues.
    for (int y = 0; y < kSize.height; ++y) {
      for (int x = 0; x < kSize.width; ++x) {
        const glm::dvec2 px(x, y);
        if (discAt(discs, px) != 0) continue;
        std::uint8_t* const p = image.row(0, y).data() + std::ptrdiff_t{4} * x;
        const bool isStripe = static_cast<int>(px.y - discs.at[0].y + 60.0) / 9 % 2 == 0;
        p[0] = 30;
        p[1] = isStripe ? 60 : 110;
        p[2] = isStripe ? 200 : 235;
      }
    }
    return image;
  }

  /// A frame with dense flow, which reaches beyond the discs, and beyond the nearer one most.
  void seeDiscs(const Discs& discs) {
    constexpr hal::FrameSize kNodes{40, 30};
    constexpr double kNodePx = 8.0;
    constexpr double kBleeding = 10.0;
    constexpr float kErrorPx = 0.1F;
    std::vector<glm::vec4> forward;
    std::vector<glm::vec4> backward;
    const Discs before{{discs.at[0] - discs.steps[0], discs.at[1] - discs.steps[1]}, discs.steps};
    for (int y = 0; y < kNodes.height; ++y) {
      for (int x = 0; x < kNodes.width; ++x) {
        const glm::dvec2 px = kNodePx * (glm::dvec2(x, y) + 0.5);
        const auto stepOf = [&](const Discs& there) {
          const std::size_t i = discAt(there, px, kBleeding);
          return i < kMovers ? glm::vec2(discs.steps.at(i)) : glm::vec2(0.0F);
        };
        forward.emplace_back(stepOf(before), kErrorPx, 0.0F);
        backward.emplace_back(-stepOf(discs), kErrorPx, 0.0F);
      }
    }
    tracking::ImageMotion motion = panning(0.0, 0.0);
    motion.picture->errorPx = 1.0;  // where the flow is known, it is the better source
    motion.flow = {
        .nodes = kNodes, .stepPx = glm::vec2(kNodePx), .forward = forward, .backward = backward};
    seeImage(pictureOf(discs), motion);
  }

  /// Counts the cells of each disc by their number (0: none), 3 px from any border.
  std::array<std::array<int, 4>, kMovers> numbersOf(const Discs& discs) const {
    constexpr double kBorder = 3.0;
    const hal::Image shares = support::readRgba8(layers_->shares());
    const hal::FrameSize size = shares.size();
    std::array<std::array<int, 4>, kMovers> found{};
    for (int i = 0; i < size.width * size.height; ++i) {
      const glm::ivec2 cell(i % size.width, i / size.width);
      const glm::dvec2 px =
          (glm::dvec2(cell) + 0.5) * static_cast<double>(MotionLayers::kCellPixels);
      const std::size_t disc = discAt(discs, px, -kBorder);
      if (disc == kMovers || discAt(discs, px, kBorder) != disc) continue;
      const std::uint8_t* const s = shares.view().planes[0].bytes.data() + std::ptrdiff_t{4} * i;
      ++found.at(disc).at(s[0] > 127 ? 1 : s[1] > 127 ? 2 : s[2] > 127 ? 3 : 0);
    }
    return found;
  }

  static double shareOf(const std::array<int, 4>& counts, std::size_t number) {
    int all = 0;
    for (const int count : counts) all += count;
    return static_cast<double>(counts.at(number)) / std::max(all, 1);
  }
  static std::size_t mostOf(const std::array<int, 4>& counts) {
    return static_cast<std::size_t>(std::ranges::max_element(counts) - counts.begin());
  }

  /// They meet at x = 160 in frame 14.
  static Discs passing(int frame, double apartY = 24.0) {
    constexpr double kSpeed = 7.0;
    const double way = kSpeed * (frame - 14);
    return {{glm::dvec2(160.0 + way, 108.0 + apartY), glm::dvec2(160.0 - way, 108.0)},
            {glm::dvec2(kSpeed, 0.0), glm::dvec2(-kSpeed, 0.0)}};
  }
  static constexpr int kFrames = 29;

 private:
  unsigned noise_ = 0;
};

TEST_F(TwoMoversTest, KeepTheirNumbersWhilePassing) {
  for (int i = 0; i < 6; ++i) see({});
  std::array<std::size_t, kMovers> numbers{};
  for (int i = 0; i < kFrames; ++i) {
    SCOPED_TRACE(i);
    const Discs discs = passing(i);
    seeDiscs(discs);
    const auto found = numbersOf(discs);
    if (i == 6) numbers = {mostOf(found[0]), mostOf(found[1])};
    if (i < 6) continue;
    ASSERT_NE(numbers[0], numbers[1]);
    EXPECT_GT(shareOf(found[0], numbers[0]), 0.9) << "of the nearer one";
    // The farther disc takes the nearer one's number for a while where it comes out from behind.
    EXPECT_GT(shareOf(found[1], numbers[1]), 0.55) << "of the other one";
  }
}

/// With one layer, the anchors of both go with the mean of both motions.
TEST_F(TwoMoversTest, AnchorsGoWithTheirOwnMover) {
  for (int i = 0; i < 6; ++i) see({});
  int own = 0;
  int all = 0;
  for (int i = 0; i < kFrames; ++i) {
    const Discs discs = passing(i);
    seeDiscs(discs);
    if (i < 10 || i > 18) continue;
    for (const Anchor& anchor : set_->read()) {
      if (!anchor.isStaying() || anchor.isBorn() || (anchor.state & Anchor::kMover) == 0) continue;
      const std::size_t disc = discAt(discs, anchor.px, -3.0);
      if (disc == kMovers || discAt(discs, anchor.px, 3.0) != disc) continue;
      ++all;
      own += glm::distance(anchor.displacementPx, glm::vec2(discs.steps.at(disc))) < 2.0F ? 1 : 0;
    }
  }
  EXPECT_GT(all, 200);
  EXPECT_GT(own, 0.93 * all) << own << " of " << all;
}

}  // namespace
}  // namespace pleinair::marks
