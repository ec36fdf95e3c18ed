#pragma once

#include <span>

#include <glm/vec3.hpp>

namespace pleinair::scene {

/// The light on a plane: the irradiance of a white surface with the normal `normal`.
struct LightSample {
  glm::dvec3 normal{0.0};   ///< unit
  double irradiance = 0.0;  ///< relative to that of a reference plane
  double weight = 1.0;      ///< 0 … 1
};

/// A distant light and uniform ambient light: irradiance(n) = ambient + max(0, n · keyVector).
struct LightFit {
  double ambient = 0.4;
  glm::dvec3 keyVector{0.0, 0.0, 0.6};  ///< towards the key light; its length is the strength

  double irradiance(const glm::dvec3& normal) const;
};

/// Confidence in a prior: standard deviations, in the samples' unit.
struct LightPriorSigma {
  double ambient = 0.2;
  double key = 0.3;  ///< per component
};

/// Fits the light to the samples and to `prior` (maximum a posteriori, Gauss–Newton; planes that
/// face away see ambient light only). Samples that no such light explains, as in a cast shadow, get
/// less weight (Huber 1964). Without samples, returns the prior.
LightFit fitLight(std::span<const LightSample> samples, const LightFit& prior,
                  const LightPriorSigma& sigma = {});

}  // namespace pleinair::scene
