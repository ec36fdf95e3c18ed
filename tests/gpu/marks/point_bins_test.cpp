// Points in bins: all there, where they belong, in an order of their own.
#include "pipeline/marks/anchors/point_bins.h"

#include <algorithm>
#include <random>
#include <span>
#include <tuple>

#include <glm/common.hpp>

#include "pipeline/marks/marks_shaders.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

using support::readBuffer;

constexpr hal::FrameSize kPicture{301, 203};

class PointBinsTest : public support::GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (!IsSkipped()) library_.add(gpu::marksShaders());
  }

  /// Holds a sort of `points` against what it is to be.
  static void expectSorted(PointBins& bins, const std::vector<BinnedPoint>& points) {
    const auto buffer = gpu::Buffer::of(std::span(points));
    bins.sort(buffer, kPicture);
    const auto starts = readBuffer<std::uint32_t>(bins.starts());
    const auto sorted = readBuffer<BinnedPoint>(bins.sorted());

    std::vector<std::pair<int, const BinnedPoint*>> wanted;  // by bin, then by slot
    for (const BinnedPoint& point : points) {
      if (point.slot == BinnedPoint::kNone) continue;
      const glm::vec2 px = glm::vec2(point.at) / BinnedPoint::kUnits;
      const glm::ivec2 bin = glm::clamp(glm::ivec2(glm::floor(px / bins.binPixels(kPicture))),
                                        glm::ivec2(0), bins.bins() - 1);
      wanted.emplace_back(bin.y * bins.bins().x + bin.x, &point);
    }
    std::ranges::stable_sort(wanted, {}, &std::pair<int, const BinnedPoint*>::first);
    ASSERT_EQ(starts.back(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const auto& [bin, point] = wanted[i];
      ASSERT_EQ(sorted[i].slot, point->slot) << i;
      ASSERT_EQ(sorted[i].at, point->at) << i;
      ASSERT_EQ(sorted[i].penalty, point->penalty) << i;
      const auto index = static_cast<std::size_t>(bin);
      ASSERT_TRUE(starts[index] <= i && i < starts[index + 1]) << i;
    }
  }

  gpu::ShaderLibrary library_;
};

std::vector<BinnedPoint> scattered(int count, unsigned seed, bool inAHeap) {
  std::mt19937 random(seed);
  std::vector<BinnedPoint> points;
  for (int slot = 0; slot < count; ++slot) {
    const bool isThere = random() % 4U != 0;
    // Up to a bin beyond the border.
    const int x = static_cast<int>(random() % (inAHeap ? 300U : 330U * 64U)) - 15 * 64;
    const int y = static_cast<int>(random() % (inAHeap ? 300U : 230U * 64U)) - 15 * 64;
    points.push_back({.at = {x, y},
                      .penalty = static_cast<std::int32_t>(random() % 1000U),
                      .slot = isThere ? slot : BinnedPoint::kNone});
  }
  return points;
}

TEST_F(PointBinsTest, HoldEveryPointWhereItLies) {
  PointBins bins(library_);
  for (const hal::FrameSize size : {hal::FrameSize{38, 25}, {1, 1}, {7, 160}}) {
    constexpr int kSlots = 1003;
    bins.allocate(size, kSlots);
    for (unsigned round = 0; round < 3; ++round) {  // one leaves the next nothing behind
      expectSorted(bins, scattered(kSlots, round, false));
    }
    expectSorted(bins, scattered(kSlots, 9, true));
    expectSorted(bins, std::vector<BinnedPoint>(kSlots));
  }
}

}  // namespace
}  // namespace pleinair::marks
