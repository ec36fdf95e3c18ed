// Each pass against the thesis's formula on the CPU.
#include <glm/vec2.hpp>

#include "tests/gpu/watercolor/watercolor_fixture.h"
#include "tests/oracles/watercolor_oracle.h"

namespace pleinair::styles {
namespace {

using oracles::Grid;
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
    grid_ = oracles::gridOf(GetParam().pixels, GetParam().cell);
    use(thesisParameters());
  }
  void TearDown() override {
    style_.reset();
    picture_ = {};
    StyleTest::TearDown();
  }

  void use(WatercolorParameters p) {
    p.cellSizePixels = GetParam().cell;
    style_->setParameters(watercolorParameters().valuesOf(p, "test"));
  }
  void paint(int number) { style_->paint(frameOf(picture_, number), "means", timer_); }

  std::vector<glm::dvec2> seeds() const {
    std::vector<glm::dvec2> result;
    for (const glm::vec2 seed : readBuffer<glm::vec2>(*style_->inner().seeds)) {
      result.emplace_back(seed);
    }
    return result;
  }
  void putSeeds(const std::vector<glm::dvec2>& seeds) {
    std::vector<glm::vec2> floats(seeds.begin(), seeds.end());
    glBindBuffer(GL_COPY_WRITE_BUFFER, style_->inner().seeds->name());
    glBufferSubData(GL_COPY_WRITE_BUFFER, 0,
                    static_cast<GLsizeiptr>(floats.size() * sizeof(glm::vec2)), floats.data());
  }
  std::vector<std::uint32_t> words() const { return readR32ui(*style_->inner().tiling); }
  std::vector<std::uint32_t> labels() const {
    std::vector<std::uint32_t> result;
    for (const std::uint32_t word : words()) {
      const std::uint32_t column = word & 0x7FFU;
      const std::uint32_t row = (word >> 11U) & 0x7FFU;
      result.push_back(row * static_cast<std::uint32_t>(grid_.columns) + column);
    }
    return result;
  }
  std::vector<bool> edges() const {
    std::vector<bool> result;
    for (const std::uint32_t word : words()) result.push_back((word & 0x400000U) != 0);
    return result;
  }

  hal::Image image_;
  gpu::Texture picture_;
  Grid grid_;
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

// Eq. 1.
TEST_P(PassTest, SeedsStartAtTheJitteredGrid) {
  WatercolorParameters p = thesisParameters();
  p.edgeThreshold = 1.0;  // without edges all stay
  use(p);
  paint(0);
  const auto found = seeds();
  const auto wanted = oracles::seedsAtHome(grid_, static_cast<std::uint32_t>(p.seed));
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    // The cells' size is a float there: the rounding to the lattice may fall otherwise.
    EXPECT_NEAR(found[k].x, wanted[k].x, 1.0 / 64.0) << k;
    EXPECT_NEAR(found[k].y, wanted[k].y, 1.0 / 64.0) << k;
    EXPECT_EQ(found[k].x * 64.0, std::floor(found[k].x * 64.0)) << k;
  }
}

TEST_P(PassTest, LabelsAreTheNearestSeeds) {
  paint(0);
  const auto seedsOfFrame = seeds();
  paint(1);
  EXPECT_EQ(labels(), oracles::voronoiLabels(grid_, seedsOfFrame));
}

// Anywhere that re-tiling may bring them: far apart, in heaps, on top of each other.
TEST_P(PassTest, LabelsAreExactForAnyAllowedSeeds) {
  paint(0);
  const auto homes = oracles::seedsAtHome(grid_, 1);
  std::mt19937 random(3);
  for (int round = 0; round < 6; ++round) {
    auto scattered = homes;
    for (auto& seed : scattered) {
      const auto corner = [&] { return static_cast<double>(random() % 3U) - 1.0; };
      const auto anywhere = [&] { return static_cast<double>(random() % 129U) / 64.0 - 1.0; };
      const bool extreme = round % 2 == 0;
      seed.x += grid_.cellWidth() * (extreme ? corner() : anywhere());
      seed.y += grid_.cellHeight() * (extreme ? corner() : anywhere());
      seed = glm::floor(seed * 64.0) / 64.0;
    }
    // The clamp is part of what is allowed.
    const std::vector<bool> noEdges(labels().size());
    scattered = oracles::retiled(grid_, labels(), noEdges, scattered, homes, 1);
    putSeeds(scattered);
    paint(round + 1);
    ASSERT_EQ(labels(), oracles::voronoiLabels(grid_, scattered)) << "round " << round;
  }
}

TEST_P(PassTest, MeansAreThoseOfTheCellsPixels) {
  paint(0);
  const auto seedsOfFrame = seeds();
  paint(1);
  const auto found = readRgba32f(*style_->inner().means);
  const auto wanted = oracles::cellMeans(grid_, image_.view(), labels(), seedsOfFrame);
  ASSERT_EQ(found.size(), wanted.size() * 4);
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

// §3.2.3.
TEST_P(PassTest, SeedsMoveToTheMeanOfTheirEdgePixels) {
  paint(0);
  auto before = seeds();
  picture_ = support::textureOf(testPicture(GetParam().pixels, 7, 11.0).view());
  paint(1);
  const auto homes = oracles::seedsAtHome(grid_, 1);
  const auto wanted = oracles::retiled(grid_, labels(), edges(), before, homes, 4);
  const auto found = seeds();
  bool anyMoved = false;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    EXPECT_NEAR(found[k].x, wanted[k].x, kTolerance) << k;
    EXPECT_NEAR(found[k].y, wanted[k].y, kTolerance) << k;
    anyMoved = anyMoved || glm::distance(before[k], wanted[k]) > 0.5;
  }
  if (GetParam().pixels.pixels() > 1000) {
    EXPECT_TRUE(anyMoved);
  }
}

}  // namespace
}  // namespace pleinair::styles
