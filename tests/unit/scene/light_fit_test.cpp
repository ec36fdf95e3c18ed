#include "pipeline/scene/light/light_fit.h"

#include <array>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <gtest/gtest.h>

namespace pleinair::scene {
namespace {

const LightFit kTruth{.ambient = 0.3, .keyVector = glm::dvec3(-0.5, -0.4, 0.6)};
const LightFit kPrior{.ambient = 0.4, .keyVector = glm::dvec3(0.2, 0.3, 0.7)};

std::vector<LightSample> samplesOf(const LightFit& light, std::span<const glm::dvec3> normals) {
  std::vector<LightSample> samples;
  for (const glm::dvec3& normal : normals) {
    const glm::dvec3 unit = glm::normalize(normal);
    samples.push_back({.normal = unit, .irradiance = light.irradiance(unit)});
  }
  return samples;
}

double degreesApart(const glm::dvec3& a, const glm::dvec3& b) {
  return glm::degrees(std::acos(glm::dot(glm::normalize(a), glm::normalize(b))));
}

TEST(LightFit, FindsTheLightThatPlanesOfManyWaysShow) {
  const std::array<glm::dvec3, 6> normals{glm::dvec3{0, 0, 1}, {0, -1, 0},  {-1, 0, 0.2},
                                          {1, 0, 0.4},         {0, 1, 0.3}, {-1, -1, 0.5}};
  const LightFit fit = fitLight(samplesOf(kTruth, normals), kPrior);
  EXPECT_LT(degreesApart(fit.keyVector, kTruth.keyVector), 9.0);
  EXPECT_NEAR(fit.ambient, kTruth.ambient, 0.06);
  const LightFit free = fitLight(samplesOf(kTruth, normals), kPrior, {.ambient = 50, .key = 50});
  EXPECT_LT(degreesApart(free.keyVector, kTruth.keyVector), 0.1);
  EXPECT_NEAR(free.ambient, kTruth.ambient, 1e-3);
}

TEST(LightFit, OnePlaneLeavesThePriorsDirection) {
  const LightFit none = fitLight({}, kPrior);
  EXPECT_LT(glm::distance(none.keyVector, kPrior.keyVector), 1e-12);
  const std::array<glm::dvec3, 1> plane{glm::dvec3{0, 0, 1}};
  LightFit same = kPrior;
  const auto samples = samplesOf(same, plane);
  EXPECT_LT(degreesApart(fitLight(samples, kPrior).keyVector, kPrior.keyVector), 1e-6);
}

/// A start that every sample faces away from has no gradient to descend.
TEST(LightFit, LeavesAPriorThatShinesFromBehind) {
  const LightFit behind{.ambient = 0.4, .keyVector = glm::dvec3(0.0, 0.3, 0.4)};
  const LightFit front{.ambient = 0.3, .keyVector = glm::dvec3(0.0, -0.9, 0.4)};
  const std::array<glm::dvec3, 3> normals{glm::dvec3{0, -1, 0}, {0.3, -1, 0}, {-0.3, -1, 0.1}};
  EXPECT_LT(fitLight(samplesOf(front, normals), behind).keyVector.y, 0.0);
}

TEST(LightFit, AShadowedPlaneCountsLess) {
  const std::array<glm::dvec3, 6> normals{glm::dvec3{0, 0, 1}, {0, -1, 0},  {-1, 0, 0.2},
                                          {1, 0, 0.4},         {0, 1, 0.3}, {-1, -1, 0.5}};
  auto samples = samplesOf(kTruth, normals);
  samples[1].irradiance *= 0.3;
  EXPECT_LT(degreesApart(fitLight(samples, kPrior).keyVector, kTruth.keyVector), 25.0);
}

}  // namespace
}  // namespace pleinair::scene
