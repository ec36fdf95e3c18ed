#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace pleinair::scene {

/// The light on a plane: what it is on a white surface that faces along `normal`.
struct LightSample {
  glm::dvec3 normal{0.0};   ///< unit
  double irradiance = 0.0;  ///< relative to some plane's
  double weight = 1.0;      ///< 0 … 1
};

/// One far light and an even one around it: irradiance(n) = ambient + max(0, n · keyVector).
struct LightFit {
  double ambient = 0.4;
  glm::dvec3 keyVector{0.0, 0.0, 0.6};  ///< towards the key light, as long as it is strong

  double irradiance(const glm::dvec3& normal) const;
};

/// How far a prior is trusted: standard deviations, in the samples' unit.
struct LightPriorSigma {
  double ambient = 0.2;
  double key = 0.3;  ///< of each component
};

/// The light that explains the samples and is not far from `prior` (maximum a posteriori,
/// Gauss–Newton; planes that face away see the ambient light only). Samples that no such light
/// explains, as in a cast shadow, count less (Huber 1964). Without samples, the prior.
LightFit fitLight(std::span<const LightSample> samples, const LightFit& prior,
                  const LightPriorSigma& sigma = {});

}  // namespace pleinair::scene
