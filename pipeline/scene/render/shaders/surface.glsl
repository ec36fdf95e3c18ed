// Purpose: what is known about the pixels of one model beyond what was drawn: their motion since the
//          frame before, their points on the surface, and their parts. Other pixels are left alone.
//          Shared by models that are virtual and those that are real.
// Inputs:  ids (ArFrame::ids); object, of ids; origin, size: of the rectangle in px that the model
//          is in; surface_point.glsl's.
// Outputs: motion RGBA16F: displacement in px since the frame before (x right, y down), predicted
//          error in px, SurfaceMotionSource (scene/ar_frame.h); barycentrics R32UI: those of the triangle's
//          first two corners, 16 bits each; parts R32UI, like ids. A pixel an invocation.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_point.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

uniform highp usampler2D ids;
uniform uint object;
uniform ivec2 origin;
uniform ivec2 size;

layout(rgba16f, binding = 0) writeonly uniform highp image2D motion;
layout(r32ui, binding = 1) writeonly uniform highp uimage2D barycentrics;
layout(r32ui, binding = 2) writeonly uniform highp uimage2D parts;

const float kSurface = 1.0;

// Defined by who includes this: of a point of the body, camera frame.
float errorAt(vec3 now);

void main() {
  ivec2 pixel = origin + ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, origin + size))) return;
  uint id = texelFetch(ids, pixel, 0).r;
  if (objectOf(id) != object) return;
  SurfacePoint point = surfacePointAt(numberOf(id), vec2(pixel) + 0.5);
  vec3 now = positionNow(point);
  vec3 then = positionThen(point);
  vec4 moved = vec4(0.0);
  if (body.turnsAbout.w != 0.0 && now.z > 0.0 && then.z > 0.0) {
    moved = vec4(projected(now) - projected(then), errorAt(now), kSurface);
  }
  imageStore(motion, pixel, moved);
  imageStore(barycentrics, pixel, uvec4(packUnorm2x16(point.barycentrics.xy)));
  imageStore(parts, pixel, uvec4(idOf(object, point.part)));
}
