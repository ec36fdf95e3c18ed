// Purpose: the ground under the strokes: its colour, with a thin first wash of the image. Movers
//          get a fuller one of their own colours: what their strokes leave bare differs with each
//          step.
// Inputs:  paint: the image, much reduced (LINEAR); moverPaint: movers, less reduced,
//          premultiplied; mover_labels.glsl's; borders (borders.glsl) if hasBorders;
//          pixelsOfFull; ground: sRGB-coded; wash: its share;
//          mixture.glsl's if isLimited.
// Outputs: 0: sRGB-coded colour; 1: the wash's height.
// Precision: mediump suffices, except for places.
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/marks/shaders/mixture.glsl"
#include "pipeline/marks/strokes/shaders/stroke_border.glsl"
uniform highp usampler2D borders;
uniform sampler2D paint;
uniform sampler2D moverPaint;
uniform vec2 size;
uniform vec2 pixelsOfFull;
uniform vec3 ground;
uniform float wash;
uniform bool isLimited;
uniform bool hasBorders;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

// Of the ground, under a mover, and more where bare paper is a part of the look, as of pencils: a part
// of what is bare elsewhere. Without it, movers look painted in another way.
const float kMostBare = 0.06;
const float kBareShare = 0.3;
const float kInside = 3.0;     // px
// A little below strokes' mean: what they leave bare would be pits with bright and dark rims.
const float kWashHeight = 0.4;

void main() {
  vec3 seen = texture(paint, gl_FragCoord.xy / size).rgb;
  float moving = movingAt(gl_FragCoord.xy / pixelsOfFull);
  float bare = 1.0 - wash;
  // At a mover's border all or nothing, as strokes (stroke_clip.glsl): as farther inside. A loop of
  // several rounds, of which software renderers run one where no invocation enters it.
  uint border = hasBorders ? texelFetch(borders, ivec2(gl_FragCoord.xy), 0).r : 0u;
  if (isMoverBorder(border) && !isMover(ownOf(border))) moving = 0.0;
  for (int i = isMoverBorder(border) && isMover(ownOf(border)) ? 0 : 4; i < 4; ++i) {
    float along = i < 2 ? -kInside : kInside;
    vec2 aside = i % 2 == 0 ? vec2(along, 0.0) : vec2(0.0, along);
    moving = max(moving, movingAt(gl_FragCoord.xy / pixelsOfFull + aside));
  }
  if (moving > 0.0) {
    vec4 mover = texture(moverPaint, gl_FragCoord.xy / size);
    if (mover.a > 0.0) seen = mix(seen, mover.rgb / mover.a, moving);
    bare = mix(bare, min(bare, max(kMostBare, kBareShare * bare)), moving);
  }
  if (isLimited) seen = mixtureOf(seen);
  colour = vec4(mix(seen, ground, bare), 1.0);
  height = vec4(kWashHeight * (1.0 - bare), 0.0, 0.0, 0.0);
}
