// Purpose: intersections of rays with the planes of a scene.
// Inputs:  those of bodies.glsl.
// Outputs: points on planes: (x, y) on the plane, and the depth.
// Precision: highp; metres.
#include "pipeline/scene/render/shaders/bodies.glsl"

const int kMaxPlanes = 8;  // scene::kMaxPlanes

// Undoes the lens distortion by fixed-point iteration, as OpenCV's undistortPoints() does.
vec3 rayThrough(vec2 px) {
  vec2 bent = (px - centre) / focal;
  vec2 p = bent;
  bool isBent = radial != vec3(0.0) || tangential != vec2(0.0) || radialBelow != vec3(0.0);
  int rounds = isBent ? 12 : 0;
  for (int i = 0; i < rounds; ++i) p = bent - lensShift(p);
  return vec3(p, 1.0);
}

// Intersection of the ray with a plane of this pose: (x, y) on the plane, and the depth; depth 0
// outside of the plane's half size.
vec3 hitOf(vec4 pose[3], vec2 halfSize, vec3 ray) {
  vec3 x = vec3(pose[0].x, pose[1].x, pose[2].x);
  vec3 y = vec3(pose[0].y, pose[1].y, pose[2].y);
  vec3 middle = vec3(pose[0].w, pose[1].w, pose[2].w);
  vec3 normal = cross(x, y);
  float along = dot(ray, normal);
  float depth = abs(along) > 1e-6 ? dot(middle, normal) / along : 0.0;
  vec3 arm = depth * ray - middle;
  vec2 at = vec2(dot(arm, x), dot(arm, y));
  bool isHit = depth > 0.0 && all(lessThanEqual(abs(at), halfSize));
  return vec3(at, isHit ? depth : 0.0);
}
