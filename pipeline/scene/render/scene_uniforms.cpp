#include "pipeline/scene/render/scene_uniforms.h"

#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/description/lens.h"
#include "pipeline/scene/light/linear_image.h"

namespace pleinair::scene {

void setLens(gpu::Program& program, const tracking::CameraModel& camera) {
  const tracking::Distortion& lens = camera.distortion();
  program.set("radial", glm::vec3(lens.k1, lens.k2, lens.k3))
      .set("tangential", glm::vec2(lens.p1, lens.p2))
      .set("radialBelow", glm::vec3(lens.k4, lens.k5, lens.k6))
      .set("trustedRadius", static_cast<float>(trustedLensRadius(lens)));
}

namespace {

constexpr float kCoding = 1.0F / 2.2F;  // approximate exponent of sRGB coding

}  // namespace

glm::vec3 shadeTint(const Lighting& light) {
  const auto hueOf = [](const glm::vec3& rgb) { return rgb / std::max(luminanceOf(rgb), 1e-4F); };
  const glm::vec3 beside = hueOf(light.sky) / glm::max(hueOf(light.white), 1e-4F);
  return glm::clamp(glm::pow(beside, glm::vec3(kCoding)), 0.75F, 1.33F);
}

float deepestShade(const Lighting& light) {
  constexpr float kThesis = 0.1F;
  constexpr float kDarkerThanSeen = 0.6F;  // painters exaggerate contrast
  if (!light.bandsAllLight) return kThesis;
  const float ambient = 0.5F * luminanceOf(light.sky + light.ground);
  const float share = ambient / std::max(luminanceOf(light.white), 1e-4F);
  return std::clamp(kDarkerThanSeen * std::pow(share, kCoding), kThesis, 1.0F);
}

void setLighting(gpu::Program& program, const Lighting& cameraLight, Shading shading) {
  program.set("towardKey", cameraLight.towardKey).set("up", cameraLight.up);
  if (shading == Shading::kSmooth) {
    program.set("keyLight", cameraLight.key)
        .set("skyLight", cameraLight.sky)
        .set("groundLight", cameraLight.ground);
    return;
  }
  const float key = luminanceOf(cameraLight.key);
  const float sky = cameraLight.bandsAllLight ? luminanceOf(cameraLight.sky) : 0.0F;
  program.set("ambientInBands", sky / std::max(sky + key, 1e-4F))
      .set("whiteLight", cameraLight.white)
      .set("shadeTint", shadeTint(cameraLight))
      .set("deepestShade", deepestShade(cameraLight));
}

}  // namespace pleinair::scene
