// Purpose: ink of hatching lines, smooth at its edges: what is thinner than a pixel is paler.
// Defines: CLIPPED: keeps a line on its own patch, or on movers, or on the background. GRAIN: the
//          brush's own mark is seen.
// Inputs:  line.vert's; scale: px of the image per px of the full one; CLIPPED: stroke_clip.glsl's;
//          GRAIN: brushes: R how much ink is there (makeBrush()); grain: its weight.
// Outputs: sRGB-coded colour, premultiplied, and coverage, to be blended over the existing ink.
// Precision: highp for places.
#ifdef CLIPPED
#include "pipeline/styles/strokes/shaders/stroke_clip.glsl"
#endif
#ifdef GRAIN
uniform sampler2D brushes;
uniform float grain;
flat in uint variant;
#endif
uniform float scale;
in vec2 brush;
in vec2 shape;
flat in vec4 paint;
layout(location = 0) out vec4 ink;

const float kSmooth = 0.75;   // stroke_strips.comp's

#ifdef GRAIN
const float kVariants = 4.0;
const float kAspect = 4.0;  // of a brush's mark

float markAt(float across) {
  // The middle half of the brush's mark, to and fro along the line.
  float times = brush.x * shape.y / (kAspect * max(2.0 * shape.x, 1.5));
  float onward = 0.25 + 0.5 * abs(1.0 - 2.0 * fract(0.5 * times));
  float row = (float(variant) + 0.5 + 0.3 * across) / kVariants;
  return mix(1.0, texture(brushes, vec2(onward, row)).r, grain);
}
#endif

void main() {
  float across = 2.0 * brush.y - 1.0;
  float halfWidth = shape.x * scale;
  float off = abs(across) * (shape.x + kSmooth) * scale;
  float cover = clamp(min(2.0 * halfWidth, halfWidth + 0.5 - off), 0.0, 1.0);
#ifdef GRAIN
  cover *= markAt(across);
#endif
#ifdef CLIPPED
  cover *= within().smoothly;
#endif
  cover *= paint.a;
  ink = vec4(paint.rgb * cover, cover);
}
