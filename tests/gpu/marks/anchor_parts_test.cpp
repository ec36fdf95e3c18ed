// Anchors on a machine of many parts, each a model of its own: as many passes as for one, the same
// anchors, and each exactly on its part.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/gpu/programs/pass_timer.h"
#include "pipeline/scene/models/model_pose.h"
#include "tests/gpu/marks/anchor_life_fixture.h"
#include "tests/oracles/surface_oracle.h"
#include "tests/support/many_parts.h"

namespace pleinair::marks {
namespace {

using support::Parts;

constexpr double kMetres = 0.3;
constexpr double kMaxSlipPx = 0.05;
constexpr int kMaxPasses = 8;

class ManyParts : public AnchorLife {
 protected:
  std::vector<Anchor> see(int frame) {
    return next(panning(0.4, 0.0), {.cameraFromWorld = support::wallBefore(kMetres, frame)});
  }

  /// The runs in a frame of the passes that carry, count and spawn anchors.
  int passesOf(const scene::Scene& scene) {
    useScene(scene);
    see(0);
    gpu::PassTimer timer(gpu::PassTiming::kFences);
    library_.setTimer(&timer);
    see(1);
    library_.setTimer(nullptr);
    int runs = 0;
    for (const gpu::PassTime& each : timer.times()) {
      if (each.pass.starts_with("anchors: anchor")) runs += each.count;
    }
    return runs;
  }
};

TEST_F(ManyParts, NeedNoMorePassesThanOne) {
  const int ofOne = passesOf(support::wallOfBoxes(1, 1, Parts::kApart));
  EXPECT_GT(ofOne, 0);
  EXPECT_LE(ofOne, kMaxPasses);
  EXPECT_EQ(passesOf(support::wallOfBoxes(25, 20, Parts::kApart)), ofOne);
}

/// As many, in as even a spread; labels of patches, which have a part in it, are numbered
/// otherwise.
TEST_F(ManyParts, HaveAsManyAnchorsAsOneWouldHave) {
  const auto play = [&](Parts parts) {
    sequence_ = 0;
    time_ = {};
    useScene(support::wallOfBoxes(25, 20, parts));
    see(0);
    std::vector<double> counts(40 * 30, 0.0);  // in cells of 8 px
    for (const Anchor& each : see(1)) {
      const glm::ivec2 cell(glm::floor(each.px / 8.0F));
      if (!each.isStaying() || cell.x < 0 || cell.x >= 40 || cell.y < 0 || cell.y >= 30) continue;
      counts[static_cast<std::size_t>(40 * cell.y + cell.x)] += 1.0;
    }
    return counts;
  };
  const std::vector<double> apart = play(Parts::kApart);
  const std::vector<double> joined = play(Parts::kJoined);
  const double total = std::accumulate(apart.begin(), apart.end(), 0.0);
  EXPECT_GT(total, 1000.0);
  EXPECT_NEAR(std::accumulate(joined.begin(), joined.end(), 0.0), total, 0.05 * total);
  int empty = 0;
  for (std::size_t i = 0; i < apart.size(); ++i) {
    empty += (apart[i] == 0.0) != (joined[i] == 0.0) ? 1 : 0;
  }
  EXPECT_LE(empty, 2) << "cells that only one of them leaves empty";
}

class SlipsOfManyParts : public ManyParts, public testing::WithParamInterface<bool> {};

TEST_P(SlipsOfManyParts, AreBelowATwentiethOfAPixel) {
  const scene::Scene scene = support::wallOfBoxes(25, 20, Parts::kApart, GetParam());
  useScene(scene);
  struct Born {
    std::size_t model = 0;
    std::optional<oracles::TrianglePoint> point;
  };
  std::vector<Born> born;
  std::vector<bool> isOn(scene.models.size());
  double worst = 0.0;
  int count = 0;
  for (int i = 0; i < 30; ++i) {
    const std::vector<Anchor> anchors = see(i);
    const auto posed = [&](std::size_t model) {
      const scene::SceneModel& each = scene.models[model];
      oracles::PosedModel made{
          .model = each.model.get(),
          .cameraFromModel = support::wallBefore(kMetres, i) * each.attachFromModel};
      poseModel(*each.model, scene::momentOf(each.model->rig, each.playback, {}), {}, made.pose);
      return made;
    };
    born.resize(anchors.size());
    for (std::size_t slot = 0; slot < anchors.size(); ++slot) {
      const Anchor& each = anchors[slot];
      const std::uint32_t object = each.surface >> scene::kTriangleBits;
      if (!each.isAlive() || object == 0) continue;
      if (each.isBorn()) {
        const std::size_t model = (object & (scene::kRealObject - 1)) - 1;
        born[slot] = {
            .model = model,
            .point = oracles::pointBehind(posed(model), each.surface & (scene::kMaxTriangles - 1),
                                          camera(), glm::dvec2(each.px))};
        continue;
      }
      if (!born[slot].point || !each.isStaying()) continue;
      const glm::dvec2 expected =
          camera().project(oracles::cameraPoint(posed(born[slot].model), *born[slot].point));
      worst = std::max(worst, glm::distance(glm::dvec2(each.px), expected));
      isOn[born[slot].model] = true;
      ++count;
    }
  }
  EXPECT_GT(count, 20000);
  EXPECT_GT(std::ranges::count(isOn, true), 100);
  EXPECT_LT(worst, kMaxSlipPx);
  RecordProperty("worst_px", std::to_string(worst));
  RecordProperty("parts", std::to_string(std::ranges::count(isOn, true)));
}

INSTANTIATE_TEST_SUITE_P(VirtualAndReal, SlipsOfManyParts, testing::Bool());

}  // namespace
}  // namespace pleinair::marks
