#include <array>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "pipeline/scene/render/shadow_casters.h"

namespace pleinair::scene {
namespace {

constexpr glm::dvec3 kFromLeft{-0.7, 0.0, 0.7};

BoundingSphere sphereAt(const glm::dvec3& centre, double radius) {
  return {.centre = centre, .radiusMetres = radius};
}

TEST(ShadowPlan, CoversWhereTheShadowOfAllFalls) {
  const std::array spheres{sphereAt({0.1, 0.2, 0.05}, 0.06), sphereAt({0.3, 0.2, 0.02}, 0.04)};
  const auto plan = planShadow(spheres, kFromLeft, std::nullopt);
  ASSERT_TRUE(plan);
  EXPECT_NEAR(plan->shear.x, 1.0, 1e-12);
  const glm::dmat4 map = plan->mapFromAttach();
  for (const BoundingSphere& sphere : spheres) {
    for (int i = 0; i < 200; ++i) {
      const double a = 0.7 * i, z = 1.0 - i / 100.0;
      const double r = std::sqrt(std::max(0.0, 1.0 - z * z));
      glm::dvec3 at =
          sphere.centre + sphere.radiusMetres * glm::dvec3(r * std::cos(a), r * std::sin(a), z);
      at.z = std::max(at.z, 0.0);
      const glm::dvec3 clip(map * glm::dvec4(at, 1.0));
      EXPECT_LE(std::abs(clip.x), 1.0);
      EXPECT_LE(std::abs(clip.y), 1.0);
      EXPECT_LE(std::abs(clip.z), 1.0);
    }
  }
  // A foot on the plane coincides with its own shadow; shadows of higher points fall away from the
  // key light.
  const glm::dvec4 foot = map * glm::dvec4(0.1, 0.2, 0.0, 1.0);
  const glm::dvec4 top = map * glm::dvec4(0.1, 0.2, 0.05, 1.0);
  EXPECT_NEAR((top.x - foot.x) * plan->half, 0.05, 1e-12);
  EXPECT_NEAR(top.y, foot.y, 1e-12);
}

TEST(ShadowPlan, StaysWhileItFits) {
  const std::array spheres{sphereAt({0.1, 0.2, 0.05}, 0.06)};
  const auto first = planShadow(spheres, kFromLeft, std::nullopt);
  const std::array nearly{sphereAt({0.102, 0.199, 0.05}, 0.0605)};
  const auto second = planShadow(nearly, kFromLeft, first);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(*second, *first);
  const std::array elsewhere{sphereAt({0.4, 0.2, 0.05}, 0.06)};
  EXPECT_NE(planShadow(elsewhere, kFromLeft, first)->centre, first->centre);
}

TEST(ShadowPlan, IsNoneFarFromThePlaneAndBoundedUnderALowLight) {
  const std::array high{sphereAt({0.0, 0.0, 0.5}, 0.05)};
  EXPECT_FALSE(planShadow(high, kFromLeft, std::nullopt));
  const std::array below{sphereAt({0.0, 0.0, -0.2}, 0.05)};
  EXPECT_FALSE(planShadow(below, kFromLeft, std::nullopt));
  const std::array near{sphereAt({0.0, 0.0, 0.05}, 0.05)};
  const auto low = planShadow(near, glm::normalize(glm::dvec3(-1.0, 0.0, 0.01)), std::nullopt);
  ASSERT_TRUE(low);
  EXPECT_LT(glm::length(low->shear), 1.61);
}

TEST(CoarseTriangles, AreFewAndWhereTheModelIs) {
  const Model gearbox = modelOf(GearboxSource{}).value();
  const DrawnModel drawn(gearbox);
  std::vector<glm::vec3> rest(drawn.rest.size());
  for (std::size_t part = 0, i = 0; part < gearbox.parts.size(); ++part) {
    for (std::uint32_t n = 0; n < gearbox.parts[part].triangleCount; ++n, ++i) {
      for (const std::uint32_t corner : drawn.triangles[i].corners) {
        rest[corner] = glm::vec3(gearbox.parts[part].modelFromPart *
                                 glm::dvec4(drawn.rest[corner].position, 1.0));
      }
    }
  }
  const double cell = boundingSphere(gearbox).radiusMetres / 28.0;
  const auto coarse = coarseTriangles(drawn, rest, cell);
  EXPECT_LT(coarse.size(), drawn.indices.size() / 3);
  EXPECT_GT(coarse.size(), 3 * 500u);
  glm::vec3 low(1e9F), high(-1e9F), coarseLow(1e9F), coarseHigh(-1e9F);
  for (const glm::vec3& each : rest) {
    low = glm::min(low, each);
    high = glm::max(high, each);
  }
  for (const std::uint32_t each : coarse) {
    ASSERT_LT(each, rest.size());
    coarseLow = glm::min(coarseLow, rest[each]);
    coarseHigh = glm::max(coarseHigh, rest[each]);
  }
  EXPECT_LT(glm::distance(low, coarseLow), 2.0 * cell);
  EXPECT_LT(glm::distance(high, coarseHigh), 2.0 * cell);
}

}  // namespace
}  // namespace pleinair::scene
