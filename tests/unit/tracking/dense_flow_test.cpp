#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <gtest/gtest.h>

#include "pipeline/tracking/image/homography.h"
#include "tests/support/textured_plane.h"
#include "tests/unit/tracking/motion_watch.h"

namespace pleinair::tracking {
namespace {

using support::currentFromPrevious;
using support::WallView;

constexpr hal::FrameSize kSize{320, 240};

struct FlowErrors {
  std::vector<double> px;
  std::vector<double> ratios;  // error over predicted error
};

/// Nodes whose position is inside of the image in both frames.
FlowErrors errorsOf(std::span<const glm::vec4> nodes, const DenseFlow& flow,
                    const glm::dmat3& truth) {
  FlowErrors out;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const int i = static_cast<int>(n);
    const glm::dvec2 px =
        glm::dvec2(flow.stepPx) * (glm::dvec2(i % flow.nodes.width, i / flow.nodes.width) + 0.5);
    const glm::dvec2 there = movedBy(truth, px);
    if (there.x < 8.0 || there.y < 8.0 || there.x > kSize.width - 8 || there.y > kSize.height - 8) {
      continue;
    }
    const double off = glm::distance(px + glm::dvec2(nodes[n]), there);
    out.px.push_back(off);
    out.ratios.push_back(off / static_cast<double>(nodes[n].z));
  }
  std::ranges::sort(out.px);
  std::ranges::sort(out.ratios);
  return out;
}

void expectExact(const FlowErrors& errors) {
  ASSERT_GT(errors.px.size(), 500U);
  EXPECT_LT(errors.px[errors.px.size() / 2], 0.1);
  EXPECT_LT(errors.px[errors.px.size() * 95 / 100], 0.6);
  const double median = errors.ratios[errors.ratios.size() / 2] / 0.83;
  EXPECT_GT(median, 0.1) << "cautious: the picture it goes along with is known better";
  EXPECT_LT(median, 2.0);
}

TEST(DenseFlow, IsMeasuredBothWays) {
  Watch watch;
  const glm::dmat3 truth =
      currentFromPrevious({.turn = 0.01, .zoom = 1.01, .shift = {5.3, -2.7}}, kSize);
  watch.step(glm::dmat3(1.0));
  for (int i = 0; i < 3; ++i) {
    const ImageMotion& motion = watch.step(truth);
    ASSERT_EQ(motion.flow.nodes, (hal::FrameSize{40, 30}));
    expectExact(errorsOf(motion.flow.forward, motion.flow, truth));
    expectExact(errorsOf(motion.flow.backward, motion.flow, glm::inverse(truth)));
  }
}

TEST(DenseFlow, IsUncertainWhereThereIsNothingToSee) {
  Watch watch;
  const glm::dmat3 still(1.0);
  const WallView plain{.size = kSize, .noiseSigma = 2.0, .contrast = 0.0, .brightness = 120.0};
  const glm::dmat3 pan = currentFromPrevious({.shift = {4.0, 0.0}}, kSize);
  for (int i = 0; i < 4; ++i) {
    WallView blank = plain;
    blank.noiseSeed = static_cast<unsigned>(900 + i);
    const ImageMotion& motion = watch.stepBehind(pan, blank, {120, 80}, {200, 160});
    if (i == 0) continue;
    for (int y = 0; y < motion.flow.nodes.height; ++y) {
      for (int x = 0; x < motion.flow.nodes.width; ++x) {
        const bool isBlank = x > 16 && x < 23 && y > 11 && y < 18;
        const auto n = static_cast<std::size_t>(y * motion.flow.nodes.width + x);
        if (!isBlank) continue;
        EXPECT_GT(motion.flow.forward[n].z, 0.4F) << x << ", " << y;
      }
    }
  }
}

}  // namespace
}  // namespace pleinair::tracking
