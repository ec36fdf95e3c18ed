#pragma once

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/description/scene.h"

namespace pleinair::scene {

/// The light that a model is shaded by where it stands. Far away, so the same all over the model.
/// Colours are linear light of the camera's picture: a white surface under this light is as bright
/// as white paper is in the picture. Directions are unit vectors; each user names their frame.
struct Lighting {
  glm::vec3 towardKey{0.0F, 0.0F, 1.0F};
  glm::vec3 up{0.0F, 0.0F, 1.0F};  ///< out of the plane that the model stands on
  glm::vec3 key{0.6F};             ///< on a white surface that faces the key light
  glm::vec3 sky{0.4F};             ///< of the ambient light, on one that faces up
  glm::vec3 ground{0.2F};          ///< of what the plane throws back, on one that faces down
  glm::vec3 white{1.0F};           ///< white paper on the plane, out of every shadow
  /// Whether toon's bands are of all light, as where it was measured or set; else of the key
  /// light's angle alone (thesis §3.2.2).
  bool bandsAllLight = false;

  friend bool operator==(const Lighting&, const Lighting&) = default;
};

/// The light on a place that models are attached to, in its attach frame.
struct PlaceLighting {
  std::optional<int> tagId;  ///< nothing: the world
  Lighting light;
};

/// What a scene says of its light, and what is usual where it says nothing, in an attach frame.
Lighting fixedLighting(const Light& light, const glm::dmat3& cameraFromAttach);

/// An estimate with what the scene says of its light put in its place.
Lighting withSceneDirection(Lighting estimate, const Light& light,
                            const glm::dmat3& cameraFromAttach);

/// The same light with its directions turned to another frame.
Lighting turned(const glm::dmat3& toFromHere, Lighting lighting);

}  // namespace pleinair::scene
