#include "pipeline/scene/light/lighting.h"

#include <algorithm>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "pipeline/scene/description/scene.h"

namespace pleinair::scene {
namespace {

constexpr float kKeyShare = 0.6F;    // of the light on the plane
constexpr float kMinKeySine = 0.4F;  // a lower key light is not strengthened further
constexpr float kReflected = 0.2F;

glm::vec3 towardLight(const Light& light, const glm::dmat3& cameraFromAttach) {
  if (light.frame == Light::Frame::kAttached) return light.towardLight;
  return glm::transpose(cameraFromAttach) * (glm::dmat3(kTagFromAttach) * light.towardLight);
}

}  // namespace

Lighting fixedLighting(const Light& light, const glm::dmat3& cameraFromAttach) {
  Lighting fixed;
  fixed.towardKey = towardLight(light, cameraFromAttach);
  const float height = std::max(fixed.towardKey.z, 0.0F);
  fixed.key = light.key.value_or(glm::vec3(kKeyShare / std::max(height, kMinKeySine)));
  fixed.sky = light.ambient.value_or(glm::vec3(1.0F - kKeyShare));
  const bool isUsual = !light.key && !light.ambient;
  fixed.white = isUsual ? glm::vec3(1.0F) : glm::min(fixed.sky + height * fixed.key, 1.0F);
  fixed.ground = kReflected * fixed.white;
  fixed.bandsAllLight = light.ambient.has_value();
  return fixed;
}

Lighting withSceneDirection(Lighting estimate, const Light& light,
                            const glm::dmat3& cameraFromAttach) {
  if (light.hasDirection) estimate.towardKey = towardLight(light, cameraFromAttach);
  return estimate;
}

Lighting turned(const glm::dmat3& toFromHere, Lighting lighting) {
  lighting.towardKey = glm::normalize(toFromHere * glm::dvec3(lighting.towardKey));
  lighting.up = glm::normalize(toFromHere * glm::dvec3(lighting.up));
  return lighting;
}

}  // namespace pleinair::scene
