// Whether the overlay is shown where it is right, and only there: against true poses.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/gpu/overlay/bench_machine.h"

namespace pleinair {
namespace {

constexpr hal::FrameSize kSize{640, 480};
constexpr double kWrongPx = 5.0;
constexpr double kRightPx = 2.0;

struct Counts {
  int frames = 0;
  int wrongAndShown = 0;  ///< any opacity
  int wrong = 0;
  int right = 0;
  int rightAndShown = 0;  ///< at least half
  double worstShownPx = 0.0;
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

Counts play(hal::SyntheticOptions options, std::vector<int> tags, int frames,
            const Change& change = nullptr, std::size_t skipped = 0) {
  options.size = kSize;
  options.framePeriod = std::chrono::milliseconds(50);
  BenchMachine bench(options, std::move(tags));
  app::ProcedureFilm film({.folder = kGearboxProcedure, .step = "end_bolts_off"}, bench.scene);
  Painter painter({.pictureSize = kSize,
                   .scene = bench.scene,
                   .style = "none",
                   .overlay = true,
                   .machine = film.machine()});
  PaintParameters parameters = painter.defaultParameters();
  parameters.overlay = film.at(hal::Duration{0}, kSize);
  const scene::Model& model = *bench.scene.models[film.machine()].model;
  std::vector<overlay::PartShape> parts;
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    if (parameters.overlay->looks[i] == overlay::PartLook::kFocus) {
      parts.push_back(overlay::shapeOf(model, i));
    }
  }
  for (std::size_t i = 0; i < skipped; ++i) bench.next();
  Counts counts;
  for (int i = 0; i < frames; ++i) {
    const auto [frame, image] = bench.next();
    if (change) change(bench, frame.sequence, *image);
    const Picture picture = hal::orThrow(painter.paint(frame, parameters));
    const auto drawn = bench.drawnCameraFromModel(picture.tracking);
    const double error =
        drawn ? trueErrorPx(bench, parts, *drawn, bench.trueCameraFromModel(frame.sequence))
              : HUGE_VAL;
    const float opacity = picture.overlay->trust.opacity;
    ++counts.frames;
    if (error > kWrongPx) {
      ++counts.wrong;
      counts.wrongAndShown += opacity > 0.0F ? 1 : 0;
    }
    if (opacity > 0.0F) counts.worstShownPx = std::max(counts.worstShownPx, error);
    if (error <= kRightPx) {
      ++counts.right;
      counts.rightAndShown += opacity >= 0.5F ? 1 : 0;
    }
  }
  std::printf("frames %d, wrong %d (shown %d), right %d (shown %d), worst shown %.2f px\n",
              counts.frames, counts.wrong, counts.wrongAndShown, counts.right, counts.rightAndShown,
              counts.worstShownPx);
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

TEST_F(OverlayTest, IsShownWhereItIsRightOnAWalkaround) {
  const Counts counts = play({.shot = hal::SyntheticShot::kWalkaround}, {0, 1, 2, 3, 4}, 40);
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
  EXPECT_GT(counts.right, 20);
}

TEST_F(OverlayTest, IsShownWhereItIsRightByOneTagAlone) {
  const Counts counts =
      play({.shot = hal::SyntheticShot::kWalkaround, .noiseSigma = 6.0}, {0}, 40, nullptr, 60);
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.95 * counts.right);
}

TEST_F(OverlayTest, IsHiddenWhileTheTagIsCovered) {
  const Change covers = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    if (sequence >= 10 && sequence < 34) cover(bench, sequence, 0, image);
  };
  const Counts counts = play({.shot = hal::SyntheticShot::kWalkaround}, {0}, 44, covers);
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.wrong, 10) << "without a tag there is no place";
}

TEST_F(OverlayTest, IsShownForAMomentWhileAllTagsAreCovered) {
  const Change covers = [](const BenchMachine& bench, std::uint64_t sequence, hal::Image& image) {
    for (const int tag : {0, 1, 2, 3, 4}) {
      if (sequence >= 10 && sequence < 28) cover(bench, sequence, tag, image);
    }
  };
  const Counts counts = play({.shot = hal::SyntheticShot::kWalkaround}, {0}, 36, covers);
  EXPECT_EQ(counts.wrongAndShown, 0);
  EXPECT_GE(counts.rightAndShown, 0.85 * counts.right) << "it comes back slowly";
}

}  // namespace
}  // namespace pleinair
