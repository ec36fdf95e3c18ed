// Purpose: three images at half size, of the background, of all models, and of movers: each the mean
//          of those of 2x2 pixels that belong to it.
// Inputs:  picture (RGBA8); ids (ArFrame) if hasObjects; mover_labels.glsl's; pixelsOfFull.
// Outputs: 0 background, 1 models, 2 movers: RGBA16F, premultiplied: alpha is the share of the 2x2
//          pixels.
// Precision: highp for places.
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
uniform sampler2D picture;
uniform highp usampler2D ids;
uniform bool hasObjects;
uniform highp vec2 pixelsOfFull;
layout(location = 0) out vec4 background;
layout(location = 1) out vec4 models;
layout(location = 2) out vec4 movingParts;

void main() {
  ivec2 last = textureSize(picture, 0) - 1;
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  vec4 real = vec4(0.0);
  models = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = min(first + ivec2(i & 1, i >> 1), last);
    vec4 seen = vec4(0.25 * texelFetch(picture, at, 0).rgb, 0.25);
    if (hasObjects && isVirtual(objectOf(texelFetch(ids, at, 0).r))) {
      models += seen;
    } else {
      real += seen;
    }
  }
  float mover = moverAt(2.0 * gl_FragCoord.xy / pixelsOfFull).r;
  background = (1.0 - mover) * real;
  movingParts = mover * real;
}
