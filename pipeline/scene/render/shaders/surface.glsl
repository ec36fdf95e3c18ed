// Purpose: per-pixel data of one model: motion since the previous frame, point on the surface, and
//          part. Other pixels are not written. Shared by virtual models and occluders.
// Inputs:  ids (ArFrame::ids); object, of ids; origin, size: the rectangle in px that contains the
//          model; those of surface_point.glsl.
// Outputs: motion RGBA16F: displacement in px since the previous frame (x right, y down), predicted
//          error in px, SurfaceMotionSource (scene/render/ar_frame.h); barycentrics R32UI: those of
//          the triangle's first two corners, 16 bits each; parts R32UI, like ids; forms R32UI
//          (surface_form.glsl). One pixel per invocation.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
#include "pipeline/scene/render/shaders/surface_point.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform highp usampler2D ids;
uniform uint object;
uniform ivec2 origin;
uniform ivec2 size;

layout(rgba16f, binding = 0) writeonly uniform highp image2D motion;
layout(r32ui, binding = 1) writeonly uniform highp uimage2D barycentrics;
layout(r32ui, binding = 2) writeonly uniform highp uimage2D parts;
layout(r32ui, binding = 3) writeonly uniform highp uimage2D forms;
layout(std430, binding = 2) readonly buffer Forms { uint triangleForms[]; };

const float kSurface = 1.0;

// Predicted error at a point of the body, camera frame. Defined by the shader that includes this
// file.
float errorAt(vec3 current);

// A direction at a point of the camera frame, as seen in the image: px per metre. The lens, which bends it
// by few degrees, is left out.
vec2 seenAlong(vec3 direction, vec3 at) {
  return focal * (direction.xy - at.xy / at.z * direction.z) / at.z;
}

// Directions along which one looks are not seen as directions.
uint formAt(uint triangle, SurfacePoint point, vec3 current) {
  const float kLeast = 0.15;
  const float kMost = 0.5;
  uint drawn = triangleForms[body.places.x + triangle];
  uint label = isVirtual(object) ? labelOfPatch(object, patchOf(drawn)) : 0u;
  vec2 corners = cornersAlong(drawn);
  vec3 last = cameraPosition(point.corners.z);
  vec3 along = corners.x * (cameraPosition(point.corners.x) - last) +
               corners.y * (cameraPosition(point.corners.y) - last);
  float size = length(along);
  if (clarityOf(drawn) == 0.0 || !(size > 0.0) || !(current.z > 0.0)) {
    return formOf(label, vec2(1.0, 0.0), 0.0, drawn & kMarks);
  }
  vec2 seen = seenAlong(along / size, current);
  float foreshortening = length(seen) * current.z / max(focal.x, focal.y);
  float clarity = clarityOf(drawn) * smoothstep(kLeast, kMost, foreshortening);
  return formOf(label, seen, clarity, drawn & kMarks);
}

void main() {
  ivec2 pixel = origin + ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, origin + size))) return;
  uint id = texelFetch(ids, pixel, 0).r;
  if (objectOf(id) != object) return;
  SurfacePoint point = surfacePointAt(numberOf(id), vec2(pixel) + 0.5);
  vec3 current = currentPosition(point);
  vec3 previous = previousPosition(point);
  vec4 moved = vec4(0.0);
  if (body.turnsAbout.w != 0.0 && current.z > 0.0 && previous.z > 0.0) {
    moved = vec4(projected(current) - projected(previous), errorAt(current), kSurface);
  }
  imageStore(motion, pixel, moved);
  imageStore(barycentrics, pixel, uvec4(packUnorm2x16(point.barycentrics.xy)));
  imageStore(parts, pixel, uvec4(idOf(object, point.part)));
  imageStore(forms, pixel, uvec4(formAt(numberOf(id), point, current)));
}
