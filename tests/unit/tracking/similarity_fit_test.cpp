#include "pipeline/tracking/motion/similarity_fit.h"

#include <array>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::tracking {
namespace {

constexpr std::array<glm::dvec2, 4> kPoints{
    {{1000.0, 700.0}, {1004.0, 700.0}, {1000.0, 703.0}, {1010.0, 690.0}}};

TEST(SimilarityFit, FindsATurnAZoomAndAShift) {
  const PlaneSimilarity wanted{{0.9, 0.3}, {-40.0, 25.0}};
  SimilarityFit fit;
  for (const glm::dvec2 point : kPoints) fit.add(point, wanted(point));
  const auto found = fit.nearest();
  ASSERT_TRUE(found);
  for (const glm::dvec2 point : kPoints) {
    EXPECT_LT(glm::distance((*found)(point), wanted(point)), 1e-6);
  }
}

TEST(SimilarityFit, WeighsItsPairs) {
  const PlaneSimilarity wanted{{1.0, 0.0}, {3.0, 0.0}};
  SimilarityFit fit;
  for (const glm::dvec2 point : kPoints) fit.add(point, wanted(point));
  fit.add({1005.0, 695.0}, {2000.0, 0.0}, 1e-9);
  EXPECT_LT(glm::distance((*fit.nearest())(kPoints[0]), wanted(kPoints[0])), 1e-3);
}

TEST(SimilarityFit, PointsInOnePlaceSayNothing) {
  SimilarityFit fit;
  EXPECT_FALSE(fit.nearest());
  for (int i = 0; i < 5; ++i) fit.add({123.456, 654.321}, {i + 0.1, 2.0});
  EXPECT_FALSE(fit.nearest());
}

}  // namespace
}  // namespace pleinair::tracking
