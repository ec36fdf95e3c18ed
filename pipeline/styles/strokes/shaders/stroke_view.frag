// Purpose: debug views of strokes.
// Inputs:  stroke_view.vert's; view: of VIEW_LAYERS (whole strokes in their layer's colour),
//          VIEW_SKELETONS (in that colour), VIEW_ANCHORS (by age); layer: its colour.
// Outputs: 0: sRGB-coded, premultiplied; 1: unused. Precision: mediump suffices.
#include "pipeline/gpu/images/shaders/luma.glsl"
uniform int view;
uniform vec3 layer;
in float across;
flat in vec4 paint;
flat in float age;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

// Young anchors are red, old ones blue.
vec3 byAge() { return mix(vec3(0.95, 0.15, 0.1), vec3(0.15, 0.35, 0.95), 1.0 - exp2(-age)); }

void main() {
  float luma = lumaOf(paint.rgb);
  vec3 whole = layer * (0.35 + 0.65 * luma) * (1.0 - 0.35 * across * across);
  vec3 rgb = view == VIEW_LAYERS ? whole : (view == VIEW_SKELETONS ? layer : byAge());
  colour = vec4(rgb * paint.a, paint.a);
  height = vec4(0.0, 0.0, 0.0, paint.a);
}
