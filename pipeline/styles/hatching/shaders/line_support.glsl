// Purpose: what a line is drawn on, and must not leave: a patch of a model, a mover, or the
//          background.
// Inputs:  forms and ids (ArFrame) if hasObjects, their pixelsOfFull; mover_labels.glsl's.
// Outputs: a patch's label (surface_form.glsl); 0 for the background, kMoverLabel for all movers.
// Precision: integers.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
uniform highp usampler2D ids;
uniform highp usampler2D forms;
uniform bool hasObjects;
uniform vec2 pixelsOfFull;

ivec2 pixelAt(vec2 px) {
  return clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(forms, 0) - 1);
}

// The camera image goes on over occluders.
uint supportAt(vec2 px) {
  uint label = hasObjects ? labelOf(texelFetch(forms, pixelAt(px), 0).r) : 0u;
  return label != 0u ? label : (moverAt(px).r > 0.5 ? kMoverLabel : 0u);
}

// `was`: the support in the previous frame, which a line on a model keeps for life; 0 of new ones.
uint supportOf(vec2 px, uint surface, uint state, uint was) {
  uint object = objectOf(surface);
  if (!isVirtual(object)) return (state & kMover) != 0u ? kMoverLabel : 0u;
  if (was != 0u && was != kMoverLabel) return was;
  if (!hasObjects) return kAnyPatch;
  // The pixel that shows the anchor's triangle is its own or one beside it.
  ivec2 found = pixelAt(px);
  ivec2 last = textureSize(ids, 0) - 1;
  for (int i = 0; i < 9 && texelFetch(ids, found, 0).r != surface; ++i) {
    ivec2 at = clamp(pixelAt(px) + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
    if (texelFetch(ids, at, 0).r == surface) found = at;
  }
  uint label = labelOf(texelFetch(forms, found, 0).r);
  return label != 0u ? label : kAnyPatch;
}
