#pragma once

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/description/scene.h"

namespace pleinair::scene {

/// The light that shades a model at its position; constant over the model, since lights are
/// distant. Colours are linear light of the camera image: a white surface under this light is as
/// bright as white paper is in the image. Directions are unit vectors; each user names their frame.
struct Lighting {
  glm::vec3 towardKey{0.0F, 0.0F, 1.0F};
  glm::vec3 up{0.0F, 0.0F, 1.0F};  ///< normal of the plane that the model stands on
  glm::vec3 key{0.6F};             ///< on a white surface that faces the key light
  glm::vec3 sky{0.4F};             ///< ambient light on a white surface that faces up
  glm::vec3 ground{0.2F};  ///< light reflected by the plane, on a white surface that faces down
  glm::vec3 white{1.0F};   ///< white paper on the plane, unshadowed
  /// Whether toon bands depend on all light, as for measured or given light; otherwise on the key
  /// light's angle only (thesis §3.2.2).
  bool bandsAllLight = false;

  friend bool operator==(const Lighting&, const Lighting&) = default;
};

/// The light on a place that models are attached to, in its attach frame.
struct PlaceLighting {
  std::optional<int> tagId;  ///< nothing: the world
  Lighting light;
};

/// The scene's light in an attach frame, with defaults where the scene gives none.
Lighting fixedLighting(const Light& light, const glm::dmat3& cameraFromAttach);

/// An estimate whose direction is replaced by the scene's, if the scene gives one.
Lighting withSceneDirection(Lighting estimate, const Light& light,
                            const glm::dmat3& cameraFromAttach);

/// The same light with its directions rotated to another frame.
Lighting turned(const glm::dmat3& toFromHere, Lighting lighting);

}  // namespace pleinair::scene
