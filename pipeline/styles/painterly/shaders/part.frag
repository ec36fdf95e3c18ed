// Purpose: two images at half size, one of the real content and one of all models: each the mean of
//          those of 2x2 pixels that belong to it.
// Inputs:  picture (RGBA8), ids (ArFrame).
// Outputs: 0 real, 1 models: RGBA16F, premultiplied: alpha is the share of the 2x2 pixels.
// Precision: highp for places.
#include "pipeline/scene/render/shaders/object_id.glsl"
uniform sampler2D picture;
uniform highp usampler2D ids;
layout(location = 0) out vec4 real;
layout(location = 1) out vec4 models;

void main() {
  ivec2 last = textureSize(picture, 0) - 1;
  ivec2 first = 2 * ivec2(gl_FragCoord.xy);
  real = vec4(0.0);
  models = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = min(first + ivec2(i & 1, i >> 1), last);
    vec4 seen = vec4(0.25 * texelFetch(picture, at, 0).rgb, 0.25);
    if (isVirtual(objectOf(texelFetch(ids, at, 0).r))) {
      models += seen;
    } else {
      real += seen;
    }
  }
}
