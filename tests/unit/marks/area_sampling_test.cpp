// The baseline that anchors are compared with, and how both are counted.
#include "pipeline/measure/baselines/area_sampling.h"

#include <array>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>
#include <gmock/gmock.h>

#include "pipeline/measure/baselines/cell_counts.h"

namespace pleinair::measure {
namespace {

TEST(AreaSampling, ChoosesTrianglesByTheirAreaAndPointsEvenly) {
  // A square of two triangles, a small one, and one without an area.
  const std::vector<Triangle> triangles{
      {glm::dvec3(0.0, 0.0, 0.0), glm::dvec3(8.0, 0.0, 0.0), glm::dvec3(0.0, 8.0, 0.0)},
      {glm::dvec3(8.0, 0.0, 0.0), glm::dvec3(8.0, 8.0, 0.0), glm::dvec3(0.0, 8.0, 0.0)},
      {glm::dvec3(10.0, 0.0, 0.0), glm::dvec3(14.0, 0.0, 0.0), glm::dvec3(10.0, 4.0, 0.0)},
      {glm::dvec3(20.0), glm::dvec3(21.0), glm::dvec3(22.0)}};
  constexpr std::size_t kCount = 72'000;  // 1,000 a unit of area
  const std::vector<SurfaceSample> samples = sampleByArea(triangles, kCount, 3);
  ASSERT_EQ(samples.size(), kCount);
  std::vector<int> chosen(triangles.size());
  std::vector<double> held(64);
  for (const SurfaceSample& sample : samples) {
    ++chosen.at(sample.triangle);
    EXPECT_NEAR(sample.barycentrics.x + sample.barycentrics.y + sample.barycentrics.z, 1.0, 1e-12);
    const glm::dvec3 place = sample.on(triangles);
    if (sample.triangle > 1) continue;
    ++held.at(static_cast<std::size_t>(place.y) * 8 + static_cast<std::size_t>(place.x));
  }
  constexpr double kDeviations = 5.0;
  EXPECT_NEAR(chosen[0], 32'000, kDeviations * std::sqrt(32'000.0));
  EXPECT_NEAR(chosen[1], 32'000, kDeviations * std::sqrt(32'000.0));
  EXPECT_NEAR(chosen[2], 8'000, kDeviations * std::sqrt(8'000.0));
  EXPECT_EQ(chosen[3], 0);
  EXPECT_THAT(held, testing::Each(testing::DoubleNear(1'000.0, kDeviations * std::sqrt(1'000.0))));
}

TEST(CellCounts, AreOfCoveredCellsOnly) {
  constexpr hal::FrameSize kSize{24, 16};  // six cells, the last of which is covered by half
  std::vector<bool> covered(static_cast<std::size_t>(kSize.pixels()), true);
  for (int y = 8; y < 16; ++y) {
    for (int x = 20; x < 24; ++x) covered[static_cast<std::size_t>(y * 24 + x)] = false;
  }
  const CellGrid grid(kSize, 8, covered);
  const std::vector<glm::dvec2> points{{1.0, 1.0},  {7.9, 7.9}, {9.0, 2.0},  {17.0, 0.0},
                                       {2.0, 15.9}, {3.0, 9.0}, {21.0, 9.0}, {-1.0, 3.0},
                                       {25.0, 3.0}, {4.0, 12.0}};
  const CellCounts counts = grid.count(points);
  EXPECT_EQ(counts.cells, 5U);
  EXPECT_DOUBLE_EQ(counts.mean, 7.0 / 5.0);  // 2, 1, 1, 3, 0
  EXPECT_DOUBLE_EQ(counts.spread, std::sqrt(15.0 / 5.0 - 49.0 / 25.0));
  EXPECT_DOUBLE_EQ(counts.empty, 0.2);
  EXPECT_EQ(counts.most, 3);
}

}  // namespace
}  // namespace pleinair::measure
