// Purpose: the borders at which strokes are clipped: those of virtual objects and of their patches
//          against each other and against real content, and those of movers against the
//          background, two pixels wide, so that a clipped edge is smooth. Occluders count as real:
//          they hide models, but the image goes on over their edges.
// Inputs:  forms (scene::ArFrame) if hasObjects; mover_labels.glsl's; size, pixelsOfFull: of the
//          frame.
// Outputs: R32UI, packed as in border.glsl.
// Precision: integers; highp for places.
#include "pipeline/scene/render/shaders/surface_form.glsl"
#include "pipeline/styles/strokes/shaders/border.glsl"
uniform highp usampler2D forms;
uniform bool hasObjects;
uniform vec2 size;
uniform vec2 pixelsOfFull;
#include "pipeline/marks/shaders/mover_labels.glsl"
layout(location = 0) out uint border;

float moverOf(ivec2 p) { return moverAt((vec2(p) + 0.5) / pixelsOfFull).r; }

uint labelAt(ivec2 p) {
  uint label = hasObjects ? labelOf(texelFetch(forms, p, 0).r) : 0u;
  if (label != 0u) return label;
  return moverOf(p) > 0.5 ? kMoverLabel : 0u;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  ivec2 last = ivec2(size) - 1;
  uint own = labelAt(p);
  uint other = own;
  float share = 0.0;
  // Labels are half as fine as the full image: where one is exactly 0 or 1, so it is all around. A
  // loop that no invocation enters costs nothing on software renderers.
  float mover = moverOf(p);
  bool isUniform = !hasObjects && pixelsOfFull.x > 0.99 && (mover == 0.0 || mover == 1.0);
  for (int i = isUniform ? 9 : 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3) - 1;
    uint label = i == 4 ? own : labelAt(clamp(p + step, ivec2(0), last));
    float weight = float((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
    if (label == own) {
      share += weight;
    } else if (other == own || label > other) {
      other = label;
    }
  }
  border = borderOf(own, other, isUniform ? 1.0 : share);
}
