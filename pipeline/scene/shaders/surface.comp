// Purpose: what is known about each pixel beyond what was drawn: its motion since the frame before,
//          its point on the surface, and its part.
// Inputs:  ids (ArFrame::ids); planeCount; surface_point.glsl's.
// Outputs: motion RGBA16F: displacement in px since the frame before (x right, y down), predicted
//          error in px, MotionSource (scene/ar_frame.h); barycentrics R32UI: those of the triangle's
//          first two corners, 16 bits each; parts R32UI, like ids. A pixel an invocation.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/scene/shaders/object_id.glsl"
#include "pipeline/scene/shaders/surface_point.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform highp usampler2D ids;
uniform int planeCount;

layout(rgba16f, binding = 0) writeonly uniform highp image2D motion;
layout(r32ui, binding = 1) writeonly uniform highp uimage2D barycentrics;
layout(r32ui, binding = 2) writeonly uniform highp uimage2D parts;

const float kUnknown = 0.0;
const float kSurface = 1.0;
const float kPlane = 2.0;

vec4 motionOf(vec3 now, vec3 then, float error, float source) {
  if (!(now.z > 0.0 && then.z > 0.0)) return vec4(0.0, 0.0, 0.0, kUnknown);
  return vec4(projected(now) - projected(then), error, source);
}

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
  vec3 origin = vec3(plane.now[0].w, plane.now[1].w, plane.now[2].w);
  vec3 normal = cross(x, y);
  float along = dot(ray, normal);
  float depth = abs(along) > 1e-6 ? dot(origin, normal) / along : 0.0;
  vec3 arm = depth * ray - origin;
  vec2 at = vec2(dot(arm, x), dot(arm, y));
  bool isHit = depth > 0.0 && all(lessThanEqual(abs(at), plane.extent.xy));
  return vec3(at, isHit ? depth : 0.0);
}

vec4 motionOfPlanes(vec2 px) {
  vec3 ray = rayThrough(px);
  vec3 nearest = vec3(0.0);
  int plane = -1;
  for (int i = 0; i < planeCount; ++i) {
    vec3 hit = hitOf(bodies[i], ray);
    if (hit.z == 0.0 || (plane >= 0 && hit.z >= nearest.z)) continue;
    nearest = hit;
    plane = i;
  }
  if (plane < 0 || bodies[plane].turnsAbout.w == 0.0) return vec4(0.0, 0.0, 0.0, kUnknown);
  vec3 now = nearest.z * ray;
  vec3 then = transformed(bodies[plane].then, vec3(nearest.xy, 0.0));
  return motionOf(now, then, predictedError(bodies[plane], now), kPlane);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = textureSize(ids, 0);
  if (pixel.x >= size.x || pixel.y >= size.y) return;
  uint id = texelFetch(ids, pixel, 0).r;
  vec2 px = vec2(pixel) + 0.5;
  if (objectOf(id) == 0u) {
    vec4 moved = vec4(0.0, 0.0, 0.0, kUnknown);
    if (planeCount > 0) moved = motionOfPlanes(px);
    imageStore(motion, pixel, moved);
    imageStore(barycentrics, pixel, uvec4(0u));
    imageStore(parts, pixel, uvec4(0u));
    return;
  }
  Body body = bodies[uint(planeCount) + objectOf(id) - 1u];
  SurfacePoint point = surfacePointAt(body, numberOf(id), px);
  vec4 moved = vec4(0.0, 0.0, 0.0, kUnknown);
  if (body.turnsAbout.w != 0.0) {
    vec3 now = positionNow(body, point);
    float error = body.extent.z != 0.0 ? predictedError(body, now) : 0.0;
    moved = motionOf(now, positionThen(body, point), error, kSurface);
  }
  imageStore(motion, pixel, moved);
  imageStore(barycentrics, pixel, uvec4(packUnorm2x16(point.barycentrics.xy)));
  imageStore(parts, pixel, uvec4(idOf(objectOf(id), point.part)));
}
