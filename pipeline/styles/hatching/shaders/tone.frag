// Purpose: the luma of the image at half size, apart for the background, also behind movers, and
//          for what is before it: models and movers.
// Inputs:  lumas (luma.frag); ids (ArFrame) if hasObjects; mover_labels.glsl's;
//          background (marks::MotionLayers); pixelsOfFull.
// Outputs: RGBA16F: the background's luma, premultiplied by the share of the 2x2 pixels where it is
//          known, which follows; the same of models and movers.
// Precision: highp for places.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
uniform sampler2D lumas;
uniform highp usampler2D ids;
uniform highp sampler2D background;
uniform bool hasObjects;
uniform highp vec2 pixelsOfFull;
layout(location = 0) out vec4 tone;

void main() {
  ivec2 last = textureSize(lumas, 0) - 1;
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  vec2 px = 2.0 * gl_FragCoord.xy / pixelsOfFull;
  float mover = moverAt(px).r;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = min(first + ivec2(i & 1, i >> 1), last);
    vec2 seen = vec2(0.25 * texelFetch(lumas, at, 0).r, 0.25);
    if (hasObjects && isVirtual(objectOf(texelFetch(ids, at, 0).r))) {
      sum.zw += seen;
    } else {
      sum.xy += (1.0 - mover) * seen;
      sum.zw += mover * seen;
    }
  }
  if (mover > 0.0) {
    vec4 behind = textureLod(background, inLayers(background, px), 0.0);
    if (behind.a >= 1.0) sum.xy += mover * vec2(lumaOf(behind.rgb), 1.0);
  }
  tone = sum;
}
