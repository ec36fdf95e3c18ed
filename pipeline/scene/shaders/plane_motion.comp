// Purpose: the motion since the frame before of pixels that show a plane of the scene.
// Inputs:  ids (ArFrame::ids); the planes' bodies, planeCount of them; origin, size: of the
//          rectangle in px that the planes are in; bodies.glsl's.
// Outputs: motion RGBA16F, as surface.comp has it; pixels of models are left alone. A pixel an
//          invocation.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/scene/shaders/bodies.glsl"
#include "pipeline/scene/shaders/object_id.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

const int kMaxPlanes = 8;  // scene::kMaxPlanes
layout(std140, binding = 0) uniform Planes { Body planes[kMaxPlanes]; };

uniform highp usampler2D ids;
uniform int planeCount;
uniform ivec2 origin;
uniform ivec2 size;

layout(rgba16f, binding = 0) writeonly uniform highp image2D motion;

const float kPlane = 2.0;

// Undoes the lens by fixed-point iteration, as OpenCV's undistortPoints() does.
vec3 rayThrough(vec2 px) {
  vec2 bent = (px - centre) / focal;
  vec2 p = bent;
  if (radial != vec3(0.0) || tangential != vec2(0.0) || radialBelow != vec3(0.0)) {
    for (int i = 0; i < 12; ++i) p = bent - lensShift(p);
  }
  return vec3(p, 1.0);
}

// Where the ray meets a plane, as (x, y) on it, and the depth; no depth (0) beyond its extent.
vec3 hitOf(Body plane, vec3 ray) {
  vec3 x = vec3(plane.now[0].x, plane.now[1].x, plane.now[2].x);
  vec3 y = vec3(plane.now[0].y, plane.now[1].y, plane.now[2].y);
  vec3 middle = vec3(plane.now[0].w, plane.now[1].w, plane.now[2].w);
  vec3 normal = cross(x, y);
  float along = dot(ray, normal);
  float depth = abs(along) > 1e-6 ? dot(middle, normal) / along : 0.0;
  vec3 arm = depth * ray - middle;
  vec2 at = vec2(dot(arm, x), dot(arm, y));
  bool isHit = depth > 0.0 && all(lessThanEqual(abs(at), plane.extent.xy));
  return vec3(at, isHit ? depth : 0.0);
}

void main() {
  ivec2 pixel = origin + ivec2(gl_GlobalInvocationID.xy);
  vec3 ray = rayThrough(vec2(pixel) + 0.5);
  vec4 moved = vec4(0.0);
  float nearest = 0.0;
  for (int i = 0; i < kMaxPlanes; ++i) {
    if (i >= planeCount) break;
    vec3 hit = hitOf(planes[i], ray);
    vec3 now = hit.z * ray;
    vec3 then = transformed(planes[i].then, vec3(hit.xy, 0.0));
    if (hit.z == 0.0 || (nearest > 0.0 && hit.z >= nearest)) continue;
    nearest = hit.z;
    bool isKnown = planes[i].turnsAbout.w != 0.0 && then.z > 0.0;
    moved = isKnown ? vec4(projected(now) - projected(then), predictedError(planes[i], now), kPlane)
                    : vec4(0.0);
  }
  if (any(greaterThanEqual(pixel, origin + size)) || nearest == 0.0) return;
  if (objectOf(texelFetch(ids, pixel, 0).r) == 0u) imageStore(motion, pixel, moved);
}
