#include "pipeline/scene/lens_uniforms.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "pipeline/scene/lens.h"

namespace pleinair::scene {

void setLens(gpu::Program& program, const tracking::CameraModel& camera) {
  const tracking::Distortion& lens = camera.distortion();
  program.set("radial", glm::vec3(lens.k1, lens.k2, lens.k3))
      .set("tangential", glm::vec2(lens.p1, lens.p2))
      .set("radialBelow", glm::vec3(lens.k4, lens.k5, lens.k6))
      .set("trustedRadius", static_cast<float>(trustedLensRadius(lens)));
}

}  // namespace pleinair::scene
