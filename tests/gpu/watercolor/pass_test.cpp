// Each pass against the thesis's formula on the CPU.
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "tests/gpu/watercolor/watercolor_fixture.h"
#include "tests/oracles/watercolor_oracle.h"

namespace pleinair::styles {
namespace {

using oracles::Site;
using support::readBuffer;
using support::readR32ui;
using support::readRgba32f;

constexpr double kThreshold = 0.06;
constexpr double kTolerance = 0.01;  // px

WatercolorParameters thesisParameters() {
  WatercolorParameters p;
  p.edgeAlpha = 0.3;
  p.edgeBeta = 0.6;
  p.edgeThreshold = kThreshold;
  p.retilePixels = 4;
  p.retileTimeSeconds = 0.0;
  p.returnTimeSeconds = 0.0;
  p.retileRest = 0.0;
  p.filterTimeSeconds = 0.0;
  p.colourTimeSeconds = 0.0;
  p.movers = false;
  return p;
}

struct Size {
  hal::FrameSize pixels;
  int cell;
};

/// The GPU's answers about one frame: the seeds that made its tiling, and what came of it.
class PassTest : public StyleTest, public testing::WithParamInterface<Size> {
 protected:
  void SetUp() override {
    StyleTest::SetUp();
    if (IsSkipped()) return;
    style_ = std::make_unique<Watercolor>(library_);
    image_ = testPicture(GetParam().pixels, 7);
    picture_ = support::textureOf(image_.view());
    use(thesisParameters());
  }

  void use(WatercolorParameters p) {
    p.cellSizePixels = GetParam().cell;
    style_->setParameters(watercolorParameters().valuesOf(p, "test"));
  }
  void paint(int number) { style_->paint(frameOf(picture_, number), "means"); }

  const CellTiling& tiler() const { return *style_->inner().tiler; }
  /// The anchors that made the last tiling, a slot each.
  std::vector<Site> sites() const {
    std::vector<Site> result;
    for (const marks::BinnedPoint& point : readBuffer<marks::BinnedPoint>(tiler().points())) {
      result.push_back({.px = glm::dvec2(point.at) / 64.0,
                        .penalty = point.penalty / 4096.0,
                        .exists = point.slot != marks::BinnedPoint::kNone});
    }
    return result;
  }
  std::vector<std::uint32_t> words() const { return readR32ui(*style_->inner().tiling); }
  std::vector<std::uint32_t> labels() const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t word : words()) result.push_back(word & 0x3FFFFFU);
    return result;
  }
  static constexpr double kRoundingPx = 1.0 / 16.0;
  /// That each pixel has the nearest site, or one as near.
  void expectNearest(const std::vector<Site>& sites) const {
    const hal::FrameSize size = GetParam().pixels;
    const auto found = labels();
    if (std::ranges::none_of(sites, &Site::exists)) return;  // so small that it has no anchor
    const auto wanted = oracles::voronoiLabels(size, sites);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const int x = static_cast<int>(i) % size.width;
      const int y = static_cast<int>(i) / size.width;
      ASSERT_LT(found[i], sites.size());
      ASSERT_TRUE(sites[found[i]].exists) << x << "," << y;
      const double least = oracles::powerDistance(sites[wanted[i]], x, y);
      // Distances are rounded where there are many seeds (shaders/tile.comp).
      const double most = std::sqrt(least) + kRoundingPx;
      ASSERT_LE(oracles::powerDistance(sites[found[i]], x, y), most * most)
          << x << "," << y << ": " << found[i] << " for " << wanted[i];
    }
  }
  std::vector<bool> edges() const {
    std::vector<bool> result;
    for (const std::uint32_t word : words()) result.push_back((word & 0x400000U) != 0);
    return result;
  }

  hal::Image image_;
  gpu::Texture picture_;
  std::unique_ptr<Watercolor> style_;
};

INSTANTIATE_TEST_SUITE_P(Sizes, PassTest,
                         testing::Values(Size{{1, 1}, 8}, Size{{1, 37}, 8}, Size{{37, 1}, 8},
                                         Size{{3, 3}, 4}, Size{{95, 61}, 64}, Size{{64, 48}, 8},
                                         Size{{83, 59}, 8}, Size{{83, 59}, 5}, Size{{160, 120}, 8},
                                         Size{{161, 118}, 13}),
                         [](const testing::TestParamInfo<Size>& each) {
                           return std::to_string(each.param.pixels.width) + "x" +
                                  std::to_string(each.param.pixels.height) + "cell" +
                                  std::to_string(each.param.cell);
                         });

// Eq. 1: about one a cell, jittered.
TEST_P(PassTest, SeedsStartAtTheirAnchors) {
  WatercolorParameters p = thesisParameters();
  p.edgeThreshold = 1.0;  // without edges all stay
  use(p);
  paint(0);
  const std::vector<Site> found = sites();
  const auto anchors = style_->anchors()->read();
  ASSERT_EQ(found.size(), anchors.size());
  int there = 0;
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_EQ(found[k].exists, anchors[k].isAlive()) << k;
    if (!found[k].exists) continue;
    ++there;
    EXPECT_NEAR(found[k].px.x, static_cast<double>(anchors[k].px.x), 1.0 / 64.0) << k;
    EXPECT_NEAR(found[k].px.y, static_cast<double>(anchors[k].px.y), 1.0 / 64.0) << k;
    EXPECT_EQ(found[k].penalty, 0.0) << k;
  }
  const double cells =
      static_cast<double>(GetParam().pixels.pixels()) / (p.cellSizePixels * p.cellSizePixels);
  if (GetParam().pixels.pixels() > 10000 && GetParam().cell == 8) {
    EXPECT_NEAR(there, cells, 0.25 * cells);
  }
}

TEST_P(PassTest, LabelsAreTheNearestSeeds) {
  paint(0);
  paint(1);
  expectNearest(sites());
}

// Anywhere that anchors may be: far apart, in heaps, on top of each other, half faded.
TEST_P(PassTest, LabelsAreExactForAnyAnchors) {
  paint(0);
  const hal::FrameSize size = GetParam().pixels;
  std::mt19937 random(3);
  const auto unit = [&] { return static_cast<float>(random() % 1024U) / 1023.0F; };
  for (int round = 0; round < 6; ++round) {
    auto anchors = style_->anchors()->read();
    for (marks::Anchor& anchor : anchors) {
      const bool heap = round % 2 == 0;
      const glm::vec2 place = heap ? glm::vec2(0.1F, 0.85F) + 0.02F * glm::vec2(unit(), unit())
                                   : glm::vec2(unit(), unit());
      anchor.px = place * glm::vec2(size.width, size.height);
      anchor.fade = round < 2 ? 1.0F : unit();
      if (round == 5 && unit() < 0.9F) anchor.state = 0;
    }
    glBindBuffer(GL_COPY_WRITE_BUFFER, style_->anchors()->anchors().name());
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0,
                    static_cast<GLsizeiptr>(anchors.size() * sizeof(marks::Anchor)),
                    anchors.data());
    paint(round + 1);
    expectNearest(sites());
  }
}

TEST_P(PassTest, MeansAreThoseOfTheCellsPixels) {
  paint(0);
  paint(1);
  const auto found = readRgba32f(tiler().means());
  const auto wanted = oracles::cellMeans(image_.view(), labels(), tiler().slots());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_EQ(found[k * 4 + 3] > 0.0F, wanted[k].pixels > 0) << k;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto channel = static_cast<glm::length_t>(c);
      EXPECT_NEAR(oracles::srgbFromLinear(static_cast<double>(found[k * 4 + c])),
                  wanted[k].srgb[channel], 1.0 / 255.0)
          << "cell " << k << " channel " << c << " of " << wanted[k].pixels << " px";
    }
  }
}

// Eq. 2-4.
TEST_P(PassTest, EdgesAreTheFormulas) {
  paint(0);
  const auto strengths = oracles::edgeStrengths(image_.view(), 0.3, 0.6);
  const auto found = words();
  int edgePixels = 0;
  for (std::size_t i = 0; i < strengths.size(); ++i) {
    const bool isEdge = (found[i] & 0x400000U) != 0;
    edgePixels += isEdge ? 1 : 0;
    if (std::abs(strengths[i] - kThreshold) > 1e-5) {
      ASSERT_EQ(isEdge, strengths[i] > kThreshold) << "pixel " << i << ": " << strengths[i];
    }
    // Eight bits hold the square root.
    const double root = (found[i] >> 24U) / 255.0;
    ASSERT_NEAR(root, std::sqrt(std::min(strengths[i], 1.0)), 0.5 / 255.0 + 1e-4) << i;
  }
  if (GetParam().pixels.pixels() > 1000) {
    EXPECT_GT(edgePixels, 100);
  }
}

// §3.2.3; at most a cell from the anchor.
TEST_P(PassTest, SeedsMoveToTheMeanOfTheirEdgePixels) {
  paint(0);
  picture_ = support::textureOf(testPicture(GetParam().pixels, 7, 11.0).view());
  paint(1);
  std::vector<glm::dvec2> before;
  for (const Site& site : sites()) before.push_back(site.px);
  const auto wanted = oracles::retiled(GetParam().pixels, labels(), edges(), before, 4);
  const auto seeds = readBuffer<CellSeed>(tiler().seeds());
  const auto anchors = style_->anchors()->read();
  bool anyMoved = false;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    if (!anchors[k].isAlive() || wanted[k] == before[k]) continue;
    glm::dvec2 away = wanted[k] - glm::dvec2(anchors[k].px);
    if (glm::length(away) > GetParam().cell) away *= GetParam().cell / glm::length(away);
    EXPECT_NEAR(static_cast<double>(seeds[k].offset.x), away.x, 2.0 * kTolerance) << k;
    EXPECT_NEAR(static_cast<double>(seeds[k].offset.y), away.y, 2.0 * kTolerance) << k;
    anyMoved = anyMoved || glm::distance(before[k], wanted[k]) > 0.5;
  }
  if (GetParam().pixels.pixels() > 1000) {
    EXPECT_TRUE(anyMoved);
  }
}

}  // namespace
}  // namespace pleinair::styles
