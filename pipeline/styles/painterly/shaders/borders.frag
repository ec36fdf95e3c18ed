// Purpose: the borders at which strokes are clipped: those of virtual objects against each other
//          and against real content, and those of movers against the background, two pixels wide,
//          so that a clipped edge is smooth. Occluders count as real: they hide models, but the
//          image goes on over their edges.
// Inputs:  ids (scene::ArFrame) if hasObjects; movers (marks::MotionLayers::labels); size: of the
//          frame.
// Outputs: R32UI, packed as in border.glsl.
// Precision: integers.
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/styles/painterly/shaders/border.glsl"
uniform usampler2D ids;
uniform bool hasObjects;
uniform highp sampler2D movers;
uniform vec2 size;
layout(location = 0) out uint border;

uint thingAt(ivec2 p) {
  uint object = hasObjects ? objectOf(texelFetch(ids, p, 0).r) : 0u;
  if (isVirtual(object)) return object;
  return textureLod(movers, (vec2(p) + 0.5) / size, 0.0).r > 0.5 ? kMoverBorder : 0u;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  ivec2 last = ivec2(size) - 1;
  uint own = 0u;
  uint other = 0u;
  float share = 0.0;
  for (int i = 0; i < 9; ++i) {
    // The middle comes first: its object decides which neighbours are others.
    ivec2 step = i == 0 ? ivec2(0) : i < 5 ? ivec2((i - 1) % 3, (i - 1) / 3) - 1 : ivec2(i % 3, i / 3) - 1;
    uint object = thingAt(clamp(p + step, ivec2(0), last));
    if (i == 0) own = other = object;
    float weight = float((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
    if (object == own) {
      share += weight;
    } else if (other == own || object > other) {
      other = object;
    }
  }
  border = borderOf(own, other, share);
}
