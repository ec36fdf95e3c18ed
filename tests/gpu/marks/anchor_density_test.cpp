// The thesis's figure 28 as figures: anchors are spread evenly over what a model shows, near and
// far; points that were drawn on its surface are not.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include <glm/ext/matrix_transform.hpp>
#include <gmock/gmock.h>

#include "pipeline/scene/builtin/builtin_box.h"
#include "pipeline/scene/description/model_source.h"
#include "tests/reports/anchors/anchor_stage.h"
#include "tests/support/gl_test.h"

namespace pleinair::marks {
namespace {

using AnchorDensity = support::GlTest;

glm::dmat4 boxAt(double metres) {
  return glm::rotate(glm::translate(glm::dmat4(1.0), {0.0, 0.0, metres}), 2.2, {0.8, 0.5, 0.1});
}

TEST_F(AnchorDensity, IsEvenNearAndFarWhereAreaSamplingIsNot) {
  AnchorStage stage(std::make_shared<const scene::Model>(
      scene::modelOf(scene::BoxSource{{0.3, 0.2, 0.1}}).value()));
  stage.advance(boxAt(0.45));
  const CellGrid nearGrid = stage.grid();
  ASSERT_GT(nearGrid.cells(), 500U);
  const CellCounts ours = nearGrid.count(stage.places());
  EXPECT_NEAR(ours.mean, 2.0, 0.05);
  EXPECT_LT(ours.spread, 0.3);
  EXPECT_EQ(ours.empty, 0.0);

  // As many in the mean, drawn on the surface.
  const std::vector<SurfaceSample> many = sampleByArea(stage.triangles(), 20'000, 1);
  const double mean = nearGrid.count(stage.seen(many)).mean;
  ASSERT_GT(mean, 2.0);
  const auto count = static_cast<std::size_t>(std::lround(20'000.0 * ours.mean / mean));
  const std::span<const SurfaceSample> samples = std::span(many).first(count);
  const CellCounts drawn = nearGrid.count(stage.seen(samples));
  EXPECT_NEAR(drawn.mean, ours.mean, 0.2);
  EXPECT_GT(drawn.spread, 1.2);
  EXPECT_GT(drawn.empty, 0.08) << "e⁻² of all would be empty of points that know nothing of cells";

  for (int i = 1; i <= 10; ++i) stage.advance(boxAt(0.45 * std::pow(2.5, i / 10.0)));
  for (int i = 0; i < 8; ++i) stage.advance(boxAt(0.45 * 2.5));
  const CellGrid farGrid = stage.grid();
  ASSERT_GT(farGrid.cells(), 20U);
  const CellCounts far = farGrid.count(stage.places());
  EXPECT_EQ(far.empty, 0.0);
  EXPECT_LE(far.most, 6) << "a cell at a corner shows three faces";
  EXPECT_GT(farGrid.count(stage.seen(samples)).mean, 8.0) << "they crowd";
}

/// The staying anchors on the model, by seed.
std::map<std::uint32_t, Anchor> stayingOf(const AnchorStage& stage) {
  std::map<std::uint32_t, Anchor> found;
  for (const Anchor& each : stage.anchors()) {
    if (each.isStaying() && each.surface != 0) found.emplace(each.seed, each);
  }
  return found;
}

double shareOf(const std::map<std::uint32_t, Anchor>& part,
               const std::map<std::uint32_t, Anchor>& all) {
  const auto count =
      std::ranges::count_if(part, [&](const auto& each) { return all.contains(each.first); });
  return static_cast<double>(count) / static_cast<double>(part.size());
}

/// A box near the camera, then 2.5 times as far away, then near again.
struct AwayAndBack {
  std::map<std::uint32_t, Anchor> nearBefore, away, nearAfter;
  CellCounts counts;  ///< far away
};

AwayAndBack goAwayAndBack(const AnchorHold& hold) {
  constexpr double kNearMetres = 0.45;
  constexpr int kFrames = 6;
  AnchorStage stage(std::make_shared<const scene::Model>(
      scene::modelOf(scene::BoxSource{{0.3, 0.2, 0.1}}).value()));
  const auto next = [&](double factor) {
    stage.advance(boxAt(kNearMetres * factor), glm::dmat3(1.0), hold);
  };
  AwayAndBack film;
  next(1.0);
  film.nearBefore = stayingOf(stage);
  for (int i = 1; i <= kFrames; ++i) next(std::pow(2.5, double(i) / kFrames));
  for (int i = 0; i < 14; ++i) next(2.5);
  film.away = stayingOf(stage);
  film.counts = stage.grid().count(stage.places());
  for (int i = kFrames - 1; i >= 0; --i) next(std::pow(2.5, double(i) / kFrames));
  for (int i = 0; i < 4; ++i) next(1.0);
  film.nearAfter = stayingOf(stage);
  return film;
}

TEST_F(AnchorDensity, WhatRemainsFarAwayIsASpreadPartOfLowRank) {
  const AwayAndBack film = goAwayAndBack({});
  EXPECT_GT(shareOf(film.away, film.nearBefore), 0.9);
  EXPECT_LT(film.away.size(), film.nearBefore.size() / 2);
  EXPECT_EQ(film.counts.empty, 0.0);
  EXPECT_LE(film.counts.most, 6);
  std::vector<std::uint32_t> ranks;
  for (const auto& [seed, anchor] : film.nearBefore) ranks.push_back(anchor.rank());
  std::ranges::sort(ranks);
  const std::uint32_t median = ranks[ranks.size() / 2];
  const auto low = std::ranges::count_if(
      film.away, [&](const auto& each) { return each.second.rank() <= median; });
  EXPECT_GT(static_cast<double>(low), 0.85 * static_cast<double>(film.away.size()));
  for (const auto& [seed, anchor] : film.away) {
    const auto was = film.nearBefore.find(seed);
    if (was == film.nearBefore.end()) continue;
    EXPECT_EQ(anchor.rank(), was->second.rank()) << "for life";
  }
}

TEST_F(AnchorDensity, WhatComesBackIsWhatWasThere) {
  const AwayAndBack film = goAwayAndBack({});
  EXPECT_GT(shareOf(film.nearAfter, film.nearBefore), 0.95);
  EXPECT_GT(shareOf(film.nearBefore, film.nearAfter), 0.85);
  const AwayAndBack forgetful = goAwayAndBack({.memory = hal::Duration(0)});
  EXPECT_LT(shareOf(forgetful.nearAfter, forgetful.nearBefore), 0.7) << "control: none sleeps";
}

}  // namespace
}  // namespace pleinair::marks
