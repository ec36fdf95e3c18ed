// Whether the overlay is shown where it is right, and only there: against true poses.
#include <cstdio>
#include <stdexcept>
#include <string>

#include "tests/gpu/overlay/overlay_fixture.h"
#include "tests/reports/overlay/truth_film.h"

namespace pleinair {
namespace {

using overlay_truth::Change;
using overlay_truth::Counts;
using overlay_truth::cover;
using overlay_truth::Film;
using overlay_truth::kAllTags;
using overlay_truth::showInstead;

Counts playAndCount(const Film& film) {
  const Counts counts = overlay_truth::countsOf(overlay_truth::play(film));
  std::printf("frames %d, wrong %d (shown %d), right %d (shown %d), worst shown %.2f px\n",
              counts.frames, counts.wrong, counts.wrongAndShown, counts.right, counts.rightAndShown,
              counts.worstShownPx);
  for (std::size_t i = 0; i < overlay::kDoubts; ++i) {
    if (counts.hiddenBy.at(i) == 0) continue;
    const auto doubt = static_cast<overlay::Doubt>(i);
    std::printf("  right and hidden: %d %s\n", counts.hiddenBy.at(i),
                doubt == overlay::Doubt::kNone ? "coming back" : nameOf(doubt).data());
  }
  return counts;
}

/// One of the films that docs/measured.md tells of.
Counts playNamed(const std::string& name) {
  for (const overlay_truth::NamedFilm& each : overlay_truth::truthFilms()) {
    if (each.name == name) return playAndCount(each.film);
  }
  throw std::invalid_argument("no film " + name);
}

void expectShownWhereItIsRightOnly(const Counts& counts) {
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
}

TEST_F(OverlayTest, IsShownWhereItIsRightOnAWalkaround) {
  const Counts counts = playNamed("walkaround, five tags");
  expectShownWhereItIsRightOnly(counts);
  EXPECT_GT(counts.right, 20);
}

TEST_F(OverlayTest, IsShownWhereItIsRightByOneTagAlone) {
  expectShownWhereItIsRightOnly(playNamed("walkaround, one tag, noise of 6 levels"));
}

TEST_F(OverlayTest, IsShownWhileAHandPassesOverTheTags) {
  expectShownWhereItIsRightOnly(playNamed("an arm reaches over the tags"));
}

TEST_F(OverlayTest, IsHiddenWhileTheTagIsCovered) {
  const Counts counts = playNamed("the machine's tag covered for 1.2 s");
  expectShownWhereItIsRightOnly(counts);
  EXPECT_GE(counts.wrong, 10) << "without a tag there is no place";
}

TEST_F(OverlayTest, IsShownForAMomentWhileAllTagsAreCovered) {
  expectShownWhereItIsRightOnly(playNamed("all tags covered for 0.9 s"));
}

/// A pose that is held while the camera rests must neither lag when it goes on nor be kept for
/// ever.
TEST_F(OverlayTest, IsShownWhereItIsRightWhileTheCameraRestsAndWhenItGoesOn) {
  const Counts counts = playNamed("held poses: the camera rests for 0.6 s and goes on");
  expectShownWhereItIsRightOnly(counts);
  EXPECT_GE(counts.right, 70);
}

TEST_F(OverlayTest, IsHiddenWhereTheTagsOfAHeldPoseAreCovered) {
  const Counts counts = playNamed("held poses, one tag, covered for 0.7 s of a rest");
  expectShownWhereItIsRightOnly(counts);
  EXPECT_GE(counts.wrong, 2) << "a pose without a tag is believed for half a second";
}

TEST_F(OverlayTest, IsHiddenAtOnceWhereAnotherMachineStands) {
  const Counts counts = playNamed("another machine's tag in the place of the machine's");
  expectShownWhereItIsRightOnly(counts);
  EXPECT_GE(counts.right, 12);
}

TEST_F(OverlayTest, ACommandCardOverTheMachinesTagIsNoOtherMachine) {
  constexpr std::uint64_t kShown = 16;
  const Change shows = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    if (sequence >= kShown) showInstead(bench, sequence, 1, 0, image);
    for (const int tag : {1, 2, 3, 4}) cover(bench, sequence, tag, image);
  };
  const Film film{.options = {.shot = hal::SyntheticShot::kWalkaround},
                  .tags = {0},
                  .frames = 22,
                  .change = shows,
                  .cards = {1}};
  const Counts counts = playAndCount(film);
  EXPECT_EQ(counts.otherMachine, 0);
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
  EXPECT_GE(counts.right, 20) << "the machine is still there, and its pose is carried";
}

/// Two tags that contradict each other: which of them is wrong cannot be known.
TEST_F(OverlayTest, IsNotWrongWhereOneOfTwoTagsHasAnotherSize) {
  for (const double factor : {0.7, 0.9, 1.4}) {
    const Counts counts = playAndCount(
        {.options = {.shot = hal::SyntheticShot::kWalkaround},
         .tags = {0, 1},
         .frames = 16,
         .author = [&](scene::Scene& scene) { scene.tags.front().edgeMetres *= factor; }});
    EXPECT_EQ(counts.wrongAndShown, 0) << factor;
  }
}

/// One of the two is covered when the painter has been made anew: alone the other looks right.
TEST_F(OverlayTest, IsNotWrongByATagThatContradictedOneBeforeANewPainter) {
  constexpr std::uint64_t kAnew = 8;
  const Change covers = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    for (const int tag : {1, 2, 3, 4}) {
      if (sequence >= kAnew) cover(bench, sequence, tag, image);
    }
  };
  const auto playWith = [&](bool keepsDoubts) {
    return playAndCount(
        {.options = {.shot = hal::SyntheticShot::kWalkaround},
         .tags = {0, 1},
         .frames = 20,
         .change = covers,
         .author = [](scene::Scene& scene) { scene.tags.front().edgeMetres *= 0.7; },
         .painterAnewAt = kAnew,
         .keepsDoubts = keepsDoubts});
  };
  EXPECT_EQ(playWith(true).wrongAndShown, 0);
  EXPECT_GT(playWith(false).wrongAndShown, 5) << "what it would be";
}

TEST_F(OverlayTest, IsNotWrongWhereTheTagWasPrintedAtAnotherSize) {
  for (const double factor : {0.7, 0.9, 1.1, 1.4}) {
    const Counts counts = playAndCount(
        {.options = {.shot = hal::SyntheticShot::kWalkaround},
         .tags = kAllTags,
         .frames = 24,
         .author = [&](scene::Scene& scene) { scene.tags.front().edgeMetres *= factor; }});
    EXPECT_EQ(counts.wrongAndShown, 0) << factor;
  }
}

TEST_F(OverlayTest, IsNotWrongInLowLight) {
  expectShownWhereItIsRightOnly(playNamed("low light: an eighth"));
}

}  // namespace
}  // namespace pleinair
