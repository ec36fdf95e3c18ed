// Purpose: motion since the previous frame of pixels that show a plane of the scene.
// Inputs:  ids (ArFrame::ids); the planes' bodies, planeCount of them; origin, size: the rectangle in
//          px that contains the planes; those of planes.glsl.
// Outputs: motion RGBA16F, as in surface.comp; pixels of models are not written. One pixel per
//          invocation.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/planes.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(std140, binding = 0) uniform Planes { Body planes[kMaxPlanes]; };

uniform highp usampler2D ids;
uniform int planeCount;
uniform ivec2 origin;
uniform ivec2 size;

layout(rgba16f, binding = 0) writeonly uniform highp image2D motion;

const float kPlane = 2.0;

void main() {
  ivec2 pixel = origin + ivec2(gl_GlobalInvocationID.xy);
  vec3 ray = rayThrough(vec2(pixel) + 0.5);
  vec4 moved = vec4(0.0);
  float nearest = 0.0;
  for (int i = 0; i < planeCount; ++i) {
    vec3 hit = hitOf(planes[i].current, planes[i].extent.xy, ray);
    vec3 current = hit.z * ray;
    vec3 previous = transformed(planes[i].previous, vec3(hit.xy, 0.0));
    if (hit.z == 0.0 || (nearest > 0.0 && hit.z >= nearest)) continue;
    nearest = hit.z;
    bool isKnown = planes[i].turnsAbout.w != 0.0 && previous.z > 0.0;
    moved = isKnown ? vec4(projected(current) - projected(previous),
                           predictedError(planes[i], current), kPlane)
                    : vec4(0.0);
  }
  if (any(greaterThanEqual(pixel, origin + size)) || nearest == 0.0) return;
  if (objectOf(texelFetch(ids, pixel, 0).r) == 0u) imageStore(motion, pixel, moved);
}
