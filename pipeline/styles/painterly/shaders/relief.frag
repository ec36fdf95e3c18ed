// Purpose: light on the relief of the paint and its canvas, once per pixel; content in focus stays
//          sharp.
// Inputs:  colours, heights (stroke_mark.glsl); mover_border.glsl's, if hasBorders;
//          ids (ArFrame) if hasObjects; substrate.glsl's: the
//          canvas; frame, normalFocus if hasFocus; relief, gloss, weave: the weight of each, the last
//          one not on models; tooth:
//          how much the substrate's grain keeps paint from its hollows, where the washed ground
//          shows, but not from those under movers, which would glide over it; mover_labels.glsl's;
//          pixelsOfFull; palette: saturation, warmth.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp for places.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/styles/strokes/shaders/mover_border.glsl"
#include "pipeline/styles/strokes/shaders/paint_light.glsl"
#include "pipeline/styles/substrate/shaders/substrate.glsl"
uniform sampler2D colours;
uniform sampler2D heights;
uniform sampler2D frame;
uniform sampler2D normalFocus;
uniform highp usampler2D ids;
uniform bool hasObjects;
uniform bool hasBorders;
uniform bool hasFocus;
uniform float relief;
uniform float gloss;
uniform float weave;
uniform float tooth;
uniform vec2 pixelsOfFull;
uniform vec3 ground;
uniform float wash;
uniform float saturation;
uniform float warmth;
layout(location = 0) out vec4 picture;

// Strokes that go with a model or a mover change the relief of each pixel, which glitters. A mover's
// paint is lit like that of no more than this relief.
const float kModelRelief = 0.75;
const float kMoverRelief = 0.9;

// Dry paint stays on the substrate's heights; more paint reaches deeper.
float caught(float height, float amount) {
  float level = mix(0.9, 0.4, amount);
  return smoothstep(level - 0.16, level + 0.16, height);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 rgb = texelFetch(colours, p, 0).rgb;
  // Each tap is the mean of four: the side of a stroke is a step in height and would flicker.
  vec2 texel = 1.0 / vec2(textureSize(heights, 0));
  vec2 place = gl_FragCoord.xy * texel;
  float nw = texture(heights, place + vec2(-0.7, -0.7) * texel).r;
  float ne = texture(heights, place + vec2(0.7, -0.7) * texel).r;
  float sw = texture(heights, place + vec2(-0.7, 0.7) * texel).r;
  float se = texture(heights, place + vec2(0.7, 0.7) * texel).r;
  float here = 0.25 * (nw + ne + sw + se);
  vec2 slope = 0.5 * vec2(ne + se - nw - sw, sw + se - nw - ne) * relief;
  float moving = movingAt(gl_FragCoord.xy / pixelsOfFull);
  bool isModel = hasObjects && isVirtual(objectOf(texelFetch(ids, p, 0).r));
  float onMover = min(1.0, kMoverRelief / max(relief, 1e-3));
  slope *= isModel ? kModelRelief : mix(1.0, onMover, moving);
  uint border = hasBorders ? texelFetch(borders, p, 0).r : 0u;
  // The heights of the two sides differ by a step that no paint has.
  if (isMoverBorder(border)) slope = vec2(0.0);
  rgb = mixedAtBorder(p, border, rgb, colours);
  vec3 normal = normalize(vec3(-slope, 1.0));
  float lit = litBy(normal);
  vec4 substrate = sheetAt(onPaper(gl_FragCoord.xy), 1.0);
  // The canvas goes with the camera's image: a model would glide over its threads.
  lit += (isModel ? 0.0 : weave) * (1.0 - 0.7 * here) * (2.0 * substrate.g - 1.0);
  if (tooth > 0.0) {
    float bare = 1.0 - caught(substrate.r, texelFetch(heights, p, 0).g);
    bare *= tooth * (1.0 - moving);
    rgb = mix(rgb, ground, bare * (1.0 - wash));
  }
  float luma = lumaOf(rgb);
  rgb = luma + (rgb - luma) * saturation;
  rgb *= vec3(1.0 + 0.12 * warmth, 1.0, 1.0 - 0.15 * warmth);
  rgb = inLight(rgb, lit) + gloss * shineOf(normal);
  if (hasFocus) {
    rgb = mix(rgb, texelFetch(frame, p, 0).rgb, texelFetch(normalFocus, p, 0).a);
  }
  picture = vec4(clamp(rgb, 0.0, 1.0), 1.0);
}
