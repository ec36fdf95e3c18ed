// Purpose: the borders at which strokes are clipped: those of virtual objects against each other
//          and against real content, and those of movers against the background, two pixels wide,
//          so that a clipped edge is smooth. Occluders count as real: they hide models, but the
//          image goes on over their edges.
// Inputs:  ids (scene::ArFrame) if hasObjects; mover_labels.glsl's; size, pixelsOfFull: of the
//          frame.
// Outputs: R32UI, packed as in border.glsl.
// Precision: integers; highp for places.
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/styles/painterly/shaders/border.glsl"
uniform usampler2D ids;
uniform bool hasObjects;
uniform vec2 size;
uniform vec2 pixelsOfFull;
#include "pipeline/marks/shaders/mover_labels.glsl"
layout(location = 0) out uint border;

float moverOf(ivec2 p) { return moverAt((vec2(p) + 0.5) / pixelsOfFull).r; }

uint thingAt(ivec2 p) {
  uint object = hasObjects ? objectOf(texelFetch(ids, p, 0).r) : 0u;
  if (isVirtual(object)) return object;
  return moverOf(p) > 0.5 ? kMoverBorder : 0u;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  ivec2 last = ivec2(size) - 1;
  uint own = thingAt(p);
  uint other = own;
  float share = 0.0;
  // Labels are half as fine as the full image: where one is exactly 0 or 1, so it is all around. A
  // loop that no invocation enters costs nothing on software renderers.
  float mover = moverOf(p);
  bool isUniform = !hasObjects && pixelsOfFull.x > 0.99 && (mover == 0.0 || mover == 1.0);
  for (int i = isUniform ? 9 : 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3) - 1;
    uint object = i == 4 ? own : thingAt(clamp(p + step, ivec2(0), last));
    float weight = float((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
    if (object == own) {
      share += weight;
    } else if (other == own || object > other) {
      other = object;
    }
  }
  border = borderOf(own, other, isUniform ? 1.0 : share);
}
