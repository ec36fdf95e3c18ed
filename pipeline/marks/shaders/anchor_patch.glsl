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

// 0 where the pixel does not show the anchor's object.
uint patchBitAt(vec2 px, uint object) {
  ivec2 pixel = clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(forms, 0) - 1);
  if (!hasObjects || objectOf(texelFetch(ids, pixel, 0).r) != object) return 0u;
  return patchBit(labelOf(texelFetch(forms, pixel, 0).r));
}
