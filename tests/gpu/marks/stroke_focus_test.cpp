// A target of density for each place: fine strokes thin out by rank away from a focus.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/description/scene.h"
#include "tests/gpu/marks/stroke_fixture.h"

namespace pleinair::marks {
namespace {

using Slots = std::set<std::size_t>;
constexpr std::uint32_t kWanted = 0x80000000U;
static_assert(scene::kMaxFoci + 1 <= FocusField::kMaxPlaces, "the picture has one, too");

/// The finer of two layers, everywhere wanted but for the focus.
StrokeRule fineRule() {
  StrokeRule rule{.segmentPx = 6.0F};
  rule.layer = 1;
  rule.layers = 2;
  return rule;
}

/// A focus beyond the image: the same target everywhere in it.
StrokeRule evenly(float strength) {
  StrokeRule rule = fineRule();
  rule.focus.add({-900.0F, -900.0F}, 1.0F, 1.0F, strength);
  return rule;
}

StrokeRule focusAt(float x, float strength = 1.0F) {
  StrokeRule rule = fineRule();
  rule.focus.add({x, 64.0F}, 24.0F, 40.0F, strength);
  return rule;
}

class StrokeFocus : public StrokeTest {
 protected:
  Slots wantedAfter(const StrokeRule& rule, int frames) {
    for (int i = 0; i < frames; ++i) advance(picture_, rule);
    return wanted();
  }
  Slots wanted() const {
    const std::vector<StrokeSlot> strokes = readStrokes();
    Slots found;
    for (const auto& [slot, anchor] : alive()) {
      if ((strokes[slot].state & kWanted) != 0U) found.insert(slot);
    }
    return found;
  }

  hal::Image picture_ =
      greyPicture(kSize, [](glm::dvec2 px) { return 0.5 + 0.3 * std::sin(0.35 * px.x); });
};

std::size_t common(const Slots& a, const Slots& b) {
  return static_cast<std::size_t>(
      std::ranges::count_if(a, [&](std::size_t slot) { return b.contains(slot); }));
}

TEST_F(StrokeFocus, WantsNoStrokesWhereThereIsTooLittleDetail) {
  StrokeRule rule = evenly(0.5F);
  EXPECT_FALSE(wantedAfter(rule, 1).empty()) << "the control";
  rule.detailBand = {1000.0F, 1e9F};
  beginAnew();
  EXPECT_EQ(wantedAfter(rule, 1), Slots{});
}

TEST_F(StrokeFocus, WithoutOneNothingIsThinned) {
  const Slots all = wantedAfter(fineRule(), 2);
  EXPECT_EQ(all.size(), alive().size());
  EXPECT_EQ(wantedAfter(evenly(0.0F), 2), all);
}

TEST_F(StrokeFocus, ATargetIsKeptBySpreadAndNestedParts) {
  const Slots all = wantedAfter(fineRule(), 2);
  const Slots most = wantedAfter(evenly(0.3F), 2);
  const Slots some = wantedAfter(evenly(0.6F), 2);
  const Slots few = wantedAfter(evenly(0.85F), 2);
  const auto count = static_cast<double>(all.size());
  constexpr double kSlack = 0.05;  // by which existing strokes stay longer
  EXPECT_NEAR(static_cast<double>(most.size()) / count, 0.7 + kSlack, 0.05);
  EXPECT_NEAR(static_cast<double>(some.size()) / count, 0.4 + kSlack, 0.05);
  EXPECT_NEAR(static_cast<double>(few.size()) / count, 0.15 + kSlack, 0.05);
  EXPECT_EQ(common(most, all), most.size());
  EXPECT_EQ(common(some, most), some.size());
  EXPECT_EQ(common(few, some), few.size());
  EXPECT_TRUE(wantedAfter(evenly(1.0F), 2).empty());

  // Squares of four cells hold 0.45 · 2 · 4 = 3.6 anchors each; of a random part, the standard
  // deviation would be 1.4 (binomial, of 8).
  std::vector<int> counts(std::size_t{10} * 5);
  for (const auto& [slot, anchor] : alive()) {
    const glm::ivec2 at(anchor.px / 24.0F);
    if (some.contains(slot) && at.x < 10 && at.y < 5) {
      ++counts[static_cast<std::size_t>(at.y * 10 + at.x)];
    }
  }
  double squares = 0.0;
  const double mean = std::accumulate(counts.begin(), counts.end(), 0.0) / 50.0;
  for (const int each : counts) squares += (each - mean) * (each - mean);
  EXPECT_LT(std::sqrt(squares / 50.0), 1.0);
  EXPECT_GE(std::ranges::min(counts), 1);
}

TEST_F(StrokeFocus, MovesWithoutBirthsAndComesBackToTheSameStrokes) {
  const Slots before = wantedAfter(focusAt(64.0F), 3);
  const std::vector<Anchor> anchors = anchors_->read();
  for (const auto& [slot, anchor] : alive()) {
    const float away = glm::distance(anchor.px, {64.0F, 64.0F});
    if (away > 24.0F && away < 64.0F) continue;
    EXPECT_EQ(before.contains(slot), away <= 24.0F) << away;
  }
  const auto moves = [&](float from, float to) {
    Slots last = wanted();
    for (int i = 1; i <= 32; ++i) {
      const Slots now = wantedAfter(focusAt(from + (to - from) * static_cast<float>(i) / 32.0F), 1);
      const std::size_t changed = last.size() + now.size() - 2 * common(last, now);
      EXPECT_LT(static_cast<double>(changed), 0.25 * static_cast<double>(last.size())) << i;
      last = now;
    }
  };
  moves(64.0F, 192.0F);
  EXPECT_LT(common(wanted(), before), before.size() / 10);
  moves(192.0F, 64.0F);
  const Slots after = wanted();
  EXPECT_GT(common(after, before), before.size() * 95 / 100);
  EXPECT_LT(after.size(), before.size() * 105 / 100);
  for (const auto& [slot, anchor] : alive()) EXPECT_EQ(anchor.seed, anchors[slot].seed);
}

TEST_F(StrokeFocus, TremblingChangesNothing) {
  wantedAfter(focusAt(127.0F), 3);
  const Slots settled = wantedAfter(focusAt(129.0F), 1);
  Slots last = wantedAfter(focusAt(127.0F), 1);
  for (int i = 0; i < 8; ++i) {
    const Slots now = wantedAfter(focusAt(i % 2 == 0 ? 128.0F : 127.0F), 1);
    EXPECT_EQ(now, last);
    last = now;
  }
  EXPECT_GT(settled.size(), 20U);
}

}  // namespace
}  // namespace pleinair::marks
