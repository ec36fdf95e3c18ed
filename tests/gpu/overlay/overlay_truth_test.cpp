// Whether the overlay is shown where it is right, and only there: against true poses.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "tests/gpu/overlay/bench_machine.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{640, 480};
constexpr double kWrongPx = 5.0;
constexpr double kRightPx = 2.0;
const std::vector<int> kAll{0, 1, 2, 3, 4};

struct Counts {
  int frames = 0;
  int wrongAndShown = 0;  ///< any opacity
  int wrong = 0;
  int right = 0;
  int rightAndShown = 0;  ///< at least half
  double worstShownPx = 0.0;
  /// Right ones that are not shown, by reason; kNone: it comes back.
  std::array<int, overlay::kDoubts> hiddenBy{};
  int otherMachine = 0;  ///< frames in which one is believed to be seen
};

/// Changes a frame before it is tracked.
using Change = std::function<void(const BenchMachine&, std::uint64_t, hal::Image&)>;

/// The true error at a step's parts: the farthest of their centres in the image.
double trueErrorPx(const BenchMachine& bench, const std::vector<overlay::PartShape>& parts,
                   const glm::dmat4& drawn, const glm::dmat4& truth) {
  double worst = 0.0;
  for (const overlay::PartShape& part : parts) {
    const glm::dvec3 is(drawn * glm::dvec4(part.centre, 1.0));
    const glm::dvec3 should(truth * glm::dvec4(part.centre, 1.0));
    if (is.z <= 0.0 || should.z <= 0.0) return HUGE_VAL;
    worst = std::max(
        worst, glm::length(bench.scene.camera->project(is) - bench.scene.camera->project(should)));
  }
  return worst;
}

/// A film of the bench.
struct Film {
  hal::SyntheticOptions options;
  std::vector<int> tags;  ///< that the scene knows
  int frames = 40;
  Change change = nullptr;
  std::size_t skipped = 0;                               ///< frames at its beginning
  std::function<void(scene::Scene&)> author = nullptr;   ///< changes the scene
  std::optional<std::uint64_t> goneFrom = std::nullopt;  ///< another machine stands there since
  std::vector<int> cards;                                ///< command cards
  std::optional<std::uint64_t> painterAnewAt = std::nullopt;  ///< as after a lost GPU
  bool keepsDoubts = true;                                    ///< over that
};

Counts play(Film played) {
  hal::SyntheticOptions& options = played.options;
  options.size = kSize;
  options.framePeriod = std::chrono::milliseconds(50);
  BenchMachine bench(options, std::move(played.tags));
  if (played.author) played.author(bench.scene);
  app::ProcedureFilm film({.folder = kGearboxProcedure, .step = "end_bolts_off"}, bench.scene);
  PainterOptions painting{.pictureSize = kSize,
                          .scene = bench.scene,
                          .style = "none",
                          .overlay = true,
                          .machine = film.machine(),
                          .doubtfulTags = std::make_shared<overlay::DoubtfulTags>()};
  std::optional<Painter> painter(std::in_place, painting);
  PaintParameters parameters = painter->defaultParameters();
  auto content = std::make_shared<overlay::OverlayContent>(*film.at(hal::Duration{0}, kSize));
  content->cards = played.cards;
  parameters.overlay = std::move(content);
  const scene::Model& model = *bench.scene.models[film.machine()].model;
  std::vector<overlay::PartShape> parts;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (parameters.overlay->looks[i] == overlay::PartLook::kFocus) {
      parts.push_back(overlay::shapeOf(model, i));
    }
  }
  for (std::size_t i = 0; i < played.skipped; ++i) bench.next();
  Counts counts;
  for (int i = 0; i < played.frames; ++i) {
    const auto [frame, image] = bench.next();
    if (played.change) played.change(bench, frame.sequence, *image);
    if (frame.sequence == played.painterAnewAt) {
      painter.reset();
      if (!played.keepsDoubts) painting.doubtfulTags.reset();
      painter.emplace(painting);
    }
    const Picture picture = hal::orThrow(painter->paint(frame, parameters));
    const auto drawn = bench.drawnCameraFromModel(picture.tracking);
    const bool isGone = played.goneFrom && frame.sequence >= *played.goneFrom;
    const double error = drawn && !isGone ? trueErrorPx(bench, parts, *drawn,
                                                        bench.trueCameraFromModel(frame.sequence))
                                          : HUGE_VAL;
    const float opacity = picture.overlay->trust.opacity;
    ++counts.frames;
    const overlay::Trust& trust = picture.overlay->trust;
    counts.otherMachine += trust.doubt == overlay::Doubt::kOtherMachine ? 1 : 0;
    if (error > kWrongPx) {
      ++counts.wrong;
      counts.wrongAndShown += opacity > 0.0F ? 1 : 0;
    }
    if (opacity > 0.0F) counts.worstShownPx = std::max(counts.worstShownPx, error);
    if (error <= kRightPx) {
      ++counts.right;
      const bool isShown = opacity >= 0.5F;
      counts.rightAndShown += isShown ? 1 : 0;
      if (!isShown) {
        const bool isBack = opacity > 0.0F;
        const auto doubt = isBack ? overlay::Doubt::kNone : picture.overlay->trust.doubt;
        ++counts.hiddenBy.at(static_cast<std::size_t>(doubt));
      }
    }
  }
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

/// Paints a rectangle over where a tag is, with its white border.
void cover(const BenchMachine& bench, std::uint64_t sequence, int tag, hal::Image& image) {
  const hal::GroundTruth truth = bench.camera.truth(sequence);
  for (const hal::TagTruth& each : truth.tags) {
    if (each.tag.id != tag) continue;
    glm::dvec2 low = each.cornersPx[0];
    glm::dvec2 high = low;
    for (const glm::dvec2& corner : each.cornersPx) {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    const glm::dvec2 margin = 0.3 * (high - low);
    low -= margin;
    high += margin;
    for (int y = std::max(0, static_cast<int>(low.y)); y < std::min<double>(kSize.height, high.y);
         ++y) {
      const auto row = image.row(0, y);
      for (int x = std::max(0, static_cast<int>(low.x)); x < std::min<double>(kSize.width, high.x);
           ++x) {
        std::fill_n(row.begin() + 3 * x, 3, std::uint8_t{120});
      }
    }
  }
}

/// Shows tag `from` where tag `to` is.
void showInstead(const BenchMachine& bench, std::uint64_t sequence, int from, int to,
                 hal::Image& image) {
  const hal::GroundTruth truth = bench.camera.truth(sequence);
  const auto cornersOf = [&](int tag) {
    std::vector<cv::Point2f> corners;
    for (const hal::TagTruth& each : truth.tags) {
      if (each.tag.id != tag) continue;
      for (const glm::dvec2& px : each.cornersPx) {
        // pixel centres at 0, as OpenCV has them
        corners.emplace_back(static_cast<float>(px.x - 0.5), static_cast<float>(px.y - 0.5));
      }
    }
    return corners;
  };
  const auto widened = [](std::vector<cv::Point2f> corners) {
    const cv::Point2f middle = 0.25F * (corners[0] + corners[1] + corners[2] + corners[3]);
    for (cv::Point2f& each : corners) each = middle + 1.2F * (each - middle);
    return corners;
  };
  const cv::Mat homography = cv::getPerspectiveTransform(cornersOf(from), cornersOf(to));
  cv::Mat whole(kSize.height, kSize.width, CV_8UC3, image.plane(0).data());
  cv::Mat moved;
  cv::warpPerspective(whole, moved, homography, whole.size());
  std::vector<cv::Point> area;
  for (const cv::Point2f& each : widened(cornersOf(to))) area.emplace_back(each);
  cv::Mat mask(whole.size(), CV_8UC1, cv::Scalar(0));
  cv::fillConvexPoly(mask, area, cv::Scalar(255));
  moved.copyTo(whole, mask);
}

TEST_F(OverlayTest, IsShownWhereItIsRightOnAWalkaround) {
  const Counts counts = play({.options = {.shot = hal::SyntheticShot::kWalkaround}, .tags = kAll});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
  EXPECT_GT(counts.right, 20);
}

TEST_F(OverlayTest, IsShownWhereItIsRightByOneTagAlone) {
  const Counts counts =
      play({.options = {.shot = hal::SyntheticShot::kWalkaround, .noiseSigma = 6.0},
            .tags = {0},
            .skipped = 60});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
}

TEST_F(OverlayTest, IsShownWhileAHandPassesOverTheTags) {
  const Counts counts = play({.options = {.shot = hal::SyntheticShot::kOccluder},
                              .tags = kAll,
                              .frames = 60,
                              .skipped = 20});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
}

TEST_F(OverlayTest, IsHiddenWhileTheTagIsCovered) {
  const Change covers = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    if (sequence >= 10 && sequence < 34) cover(bench, sequence, 0, image);
  };
  const Counts counts = play({.options = {.shot = hal::SyntheticShot::kWalkaround},
                              .tags = {0},
                              .frames = 44,
                              .change = covers});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
  EXPECT_GE(counts.wrong, 10) << "without a tag there is no place";
}

TEST_F(OverlayTest, IsShownForAMomentWhileAllTagsAreCovered) {
  const Change covers = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    for (const int tag : kAll) {
      if (sequence >= 10 && sequence < 28) cover(bench, sequence, tag, image);
    }
  };
  const Counts counts = play({.options = {.shot = hal::SyntheticShot::kWalkaround},
                              .tags = {0},
                              .frames = 36,
                              .change = covers});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
}

TEST_F(OverlayTest, IsHiddenAtOnceWhereAnotherMachineStands) {
  constexpr std::uint64_t kSwapped = 16;
  const Change swaps = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    if (sequence >= kSwapped) showInstead(bench, sequence, 1, 0, image);
    for (const int tag : {1, 2, 3, 4}) cover(bench, sequence, tag, image);
  };
  const Counts counts = play({.options = {.shot = hal::SyntheticShot::kWalkaround},
                              .tags = {0},
                              .change = swaps,
                              .goneFrom = kSwapped});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
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
  const Counts counts = play(film);
  EXPECT_EQ(counts.otherMachine, 0);
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
  EXPECT_GE(counts.right, 20) << "the machine is still there, and its pose is carried";
}

/// Two tags that contradict each other: which of them is wrong cannot be known.
TEST_F(OverlayTest, IsNotWrongWhereOneOfTwoTagsHasAnotherSize) {
  for (const double factor : {0.7, 0.9, 1.4}) {
    const Counts counts =
        play({.options = {.shot = hal::SyntheticShot::kWalkaround},
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
    return play({.options = {.shot = hal::SyntheticShot::kWalkaround},
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
    const Counts counts =
        play({.options = {.shot = hal::SyntheticShot::kWalkaround},
              .tags = kAll,
              .frames = 24,
              .author = [&](scene::Scene& scene) { scene.tags.front().edgeMetres *= factor; }});
    EXPECT_EQ(counts.wrongAndShown, 0) << factor;
  }
}

TEST_F(OverlayTest, IsNotWrongInLowLight) {
  const Change darkens = [](const BenchMachine&, std::uint64_t, hal::Image& image) {
    for (std::uint8_t& each : image.plane(0)) each = static_cast<std::uint8_t>(each / 8);
  };
  const Counts counts =
      play({.options = {.shot = hal::SyntheticShot::kWalkaround, .noiseSigma = 16.0},
            .tags = kAll,
            .change = darkens});
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
}

}  // namespace
}  // namespace pleinair
