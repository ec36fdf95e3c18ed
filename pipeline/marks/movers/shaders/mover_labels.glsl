// Purpose: what of the image belongs to movers (marks::MotionLayers::labels).
// Inputs:  movers; places in px of the full image.
// Outputs: mover: in [0, 1]; freshness: 1 where that has just changed.
// Precision: highp.
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
uniform highp sampler2D movers;

vec2 moverAt(vec2 px) { return textureLod(movers, inLayers(movers, px), 0.0).rg; }

// The label, falling to 0 while a mover rests, before it joins the background: what has been seen to
// move for kMatureSeconds (motion_layers.glsl) rests for longer.
float movingAt(vec2 px) {
  vec2 at = inLayers(movers, px);
  vec4 label = textureLod(movers, at, 0.0);
  vec4 rests = textureGather(movers, at, 2);  // what is no mover has none
  float rest = max(max(rests.x, rests.y), max(rests.z, rests.w));
  vec2 fade = label.a > 0.2 ? vec2(0.5, 3.5) : vec2(0.4, 0.7);
  return label.r * (1.0 - smoothstep(fade.x, fade.y, rest));
}

#include "pipeline/marks/movers/shaders/mover_near.glsl"
