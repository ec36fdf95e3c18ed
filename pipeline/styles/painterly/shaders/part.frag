// Purpose: images at half size, of the background, of movers, and of all models: each the mean of
//          those of 2x2 pixels that belong to it.
// Defines: MODELS: there may be any.
// Inputs:  picture (RGBA8); MODELS: ids (ArFrame) if hasObjects; mover_labels.glsl's; pixelsOfFull.
// Outputs: 0 background, 1 movers, 2 with MODELS: models: RGBA16F, premultiplied: alpha is the share of the 2x2
//          pixels.
// Precision: highp for places.
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
uniform sampler2D picture;
uniform highp vec2 pixelsOfFull;
layout(location = 0) out vec4 background;
layout(location = 1) out vec4 movingParts;
#ifdef MODELS
#include "pipeline/scene/render/shaders/object_id.glsl"
uniform highp usampler2D ids;
uniform bool hasObjects;
layout(location = 2) out vec4 models;
#endif

void main() {
  ivec2 last = textureSize(picture, 0) - 1;
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  vec4 real = vec4(0.0);
#ifdef MODELS
  models = vec4(0.0);
#endif
  for (int i = 0; i < 4; ++i) {
    ivec2 at = min(first + ivec2(i & 1, i >> 1), last);
    vec4 seen = vec4(0.25 * texelFetch(picture, at, 0).rgb, 0.25);
#ifdef MODELS
    bool isModel = hasObjects && isVirtual(objectOf(texelFetch(ids, at, 0).r));
    models += isModel ? seen : vec4(0.0);
    seen *= isModel ? 0.0 : 1.0;
#endif
    real += seen;
  }
  float mover = moverAt(2.0 * gl_FragCoord.xy / pixelsOfFull).r;
  background = (1.0 - mover) * real;
  movingParts = mover * real;
}
