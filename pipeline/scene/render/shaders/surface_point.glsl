// Purpose: the exact point of a model's surface at a pixel: the corners of its triangle and
//          perspective-correct barycentrics, as the rasteriser computes them.
// Inputs:  posed_surface.glsl's; the model's body; those of bodies.glsl.
// Outputs: the point, and its position in this frame and the previous one (camera frame, metres).
// Precision: highp. Barycentrics are computed from areas relative to the pixel, which keeps precision.
#include "pipeline/scene/render/shaders/bodies.glsl"
#include "pipeline/scene/render/shaders/posed_surface.glsl"
layout(std140, binding = 0) uniform OneBody { Body body; };

vec3 cameraPosition(uint corner) {
  return transformed(body.current, posed[body.places.y + corner].position);
}

// In px, times depth, relative to the pixel's centre: linear on the triangle, even if a corner is
// behind the camera.
vec2 fromPixel(vec3 cameraPoint, vec2 px) {
  vec3 p = throughLens(cameraPoint);
  return focal * p.xy + (centre - px) * p.z;
}

SurfacePoint surfacePointAt(uint triangle, vec2 px) {
  uvec4 entry = triangles[body.places.x + triangle];
  vec2 a = fromPixel(cameraPosition(entry.x), px);
  vec2 b = fromPixel(cameraPosition(entry.y), px);
  vec2 c = fromPixel(cameraPosition(entry.z), px);
  vec3 areas = vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
  float sum = areas.x + areas.y + areas.z;
  vec3 at = abs(sum) > 0.0 ? areas / sum : vec3(1.0 / 3.0);
  at = clamp(at, 0.0, 1.0);  // rounding may put a pixel's centre beyond the edge
  return SurfacePoint(entry.xyz, entry.w, at / (at.x + at.y + at.z));
}

vec3 currentPosition(SurfacePoint point) {
  return transformed(body.current, positionOf(point, body.places.y));
}

// Precondition: the model's previous pose is known.
vec3 previousPosition(SurfacePoint point) {
  return transformed(body.previous, positionOf(point, body.places.z));
}
