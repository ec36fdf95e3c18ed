// Purpose: a model's surface.
// Defines: TOON: shaded in toon bands; without, smoothly. MASKED: the surface is not there where its
//          coverage is low; without, it is solid.
// Inputs:  model_surface.glsl's; shading_toon.glsl's or shading_smooth.glsl's; MASKED:
//          coverageCutoff, below which nothing is.
// Outputs: model_surface.glsl's. Precision: as there.
#include "pipeline/scene/render/shaders/model_surface.glsl"
#ifdef TOON
#include "pipeline/scene/render/shaders/shading_toon.glsl"
#else
#include "pipeline/scene/render/shaders/shading_smooth.glsl"
#endif
#ifdef MASKED
uniform float coverageCutoff;
#endif

void main() {
  vec4 surface = surfaceColour();
#ifdef MASKED
  if (surface.a < coverageCutoff) discard;
#endif
  writeSurface(surface.rgb);
}
