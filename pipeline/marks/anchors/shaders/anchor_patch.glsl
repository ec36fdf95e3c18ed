// Purpose: the patch that an anchor's pixel shows, and whether it shows a model.
// Inputs:  ids and forms (ArFrame) and their pixelsOfFull if hasObjects; px of the full image.
// Outputs: its bit in Cell::patches.
// Precision: highp; integers.
#include "pipeline/scene/render/shaders/surface_form.glsl"
uniform highp usampler2D ids;
uniform highp usampler2D forms;
uniform bool hasObjects;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;

bool showsModel(vec2 px) {
  ivec2 pixel = clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(ids, 0) - 1);
  return hasObjects && isVirtual(objectOf(texelFetch(ids, pixel, 0).r));
}

// 0 where neither the pixel nor one beside it shows the anchor's object. At an edge, the one that
// shows its triangle counts.
uint patchBitAt(vec2 px, uint surface) {
  if (!hasObjects) return 0u;
  vec2 at = px * pixelsOfFull;
  ivec2 aside = ivec2(greaterThan(fract(at), vec2(0.5))) * 2 - 1;
  ivec2 last = textureSize(forms, 0) - 1;
  uint found = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 there = clamp(ivec2(floor(at)) + aside * ivec2(i & 1, i >> 1), ivec2(0), last);
    uint id = texelFetch(ids, there, 0).r;
    if (objectOf(id) != objectOf(surface) || (id != surface && found != 0u)) continue;
    found = patchBit(labelOf(texelFetch(forms, there, 0).r));
    if (id == surface) return found;
  }
  return found;
}
