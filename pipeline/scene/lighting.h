#pragma once

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

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
};

/// The same light with its directions turned to another frame.
inline Lighting turned(const glm::mat3& toFromHere, Lighting lighting) {
  lighting.towardKey = toFromHere * lighting.towardKey;
  lighting.up = toFromHere * lighting.up;
  return lighting;
}

}  // namespace pleinair::scene
