#include "pipeline/scene/light/light_fit.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

namespace pleinair::scene {
namespace {

constexpr double kSampleSigma = 0.10;  // variation of a real room's light between places
constexpr double kHuber = 2.5;         // sigmas
constexpr double kMinAmbient = 0.08;
constexpr int kSteps = 8;

double square(double value) {
  return value * value;
}

struct Problem {
  std::span<const LightSample> samples;
  const LightFit& prior;
  const LightPriorSigma& sigma;

  double cost(const LightFit& fit) const {
    double sum = square((fit.ambient - prior.ambient) / sigma.ambient) +
                 square(glm::distance(fit.keyVector, prior.keyVector) / sigma.key);
    for (const LightSample& sample : samples) {
      const double off = std::abs(sample.irradiance - fit.irradiance(sample.normal)) / kSampleSigma;
      sum += sample.weight * (off < kHuber ? off * off : kHuber * (2.0 * off - kHuber));
    }
    return sum;
  }

  LightFit solvedFrom(LightFit fit) const {
    const glm::dvec4 precision(1.0 / square(sigma.ambient), glm::dvec3(1.0 / square(sigma.key)));
    const glm::dvec4 expected(prior.ambient, prior.keyVector);
    for (int step = 0; step < kSteps; ++step) {
      glm::dmat4 normalEquations(0.0);
      for (int i = 0; i < 4; ++i) normalEquations[i][i] = precision[i];
      glm::dvec4 right = precision * expected;
      for (const LightSample& sample : samples) {
        const bool isLit = glm::dot(sample.normal, fit.keyVector) > 0.0;
        const glm::dvec4 row(1.0, isLit ? sample.normal : glm::dvec3(0.0));
        const double off =
            std::abs(sample.irradiance - fit.irradiance(sample.normal)) / kSampleSigma;
        const double huber = off > kHuber ? kHuber / off : 1.0;
        const double weight = sample.weight * huber / square(kSampleSigma);
        normalEquations += weight * glm::outerProduct(row, row);
        right += weight * sample.irradiance * row;
      }
      const glm::dvec4 solved = glm::inverse(normalEquations) * right;
      fit = {.ambient = std::max(solved.x, kMinAmbient),
             .keyVector = glm::dvec3(solved.y, solved.z, solved.w)};
    }
    return fit;
  }
};

}  // namespace

double LightFit::irradiance(const glm::dvec3& normal) const {
  return ambient + std::max(0.0, glm::dot(normal, keyVector));
}

LightFit fitLight(std::span<const LightSample> samples, const LightFit& prior,
                  const LightPriorSigma& sigma) {
  const Problem problem{samples, prior, sigma};
  // Planes that face away from the start's key light carry no information about it: try other
  // starts.
  LightFit best = problem.solvedFrom(prior);
  double lowestCost = problem.cost(best);
  for (const LightSample& sample : samples) {
    const double strength = glm::length(prior.keyVector);
    const LightFit fit = problem.solvedFrom(
        {.ambient = prior.ambient,
         .keyVector = strength * glm::normalize(glm::normalize(prior.keyVector) + sample.normal)});
    const double cost = problem.cost(fit);
    if (!(cost < lowestCost)) continue;
    best = fit;
    lowestCost = cost;
  }
  return best;
}

}  // namespace pleinair::scene
