// Purpose: the ground under the strokes: its colour, with a thin first wash of the image.
// Inputs:  paint: the image, much reduced (LINEAR); ground: sRGB-coded; wash: its share;
//          mixture.glsl's if isLimited.
// Outputs: 0: sRGB-coded colour; 1: no height.
// Precision: mediump suffices, except for places.
#include "pipeline/marks/shaders/mixture.glsl"
uniform sampler2D paint;
uniform vec2 size;
uniform vec3 ground;
uniform float wash;
uniform bool isLimited;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

void main() {
  vec3 seen = texture(paint, gl_FragCoord.xy / size).rgb;
  if (isLimited) seen = mixtureOf(seen);
  colour = vec4(mix(ground, seen, wash), 1.0);
  height = vec4(0.0);
}
