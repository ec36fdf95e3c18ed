// Purpose: each pixel's edge as a tensor: the gradient by Sobel's operator (thesis eq. 5-8) in the
//          doubled angle (eq. 9), in which directions have no sign and can be added. On virtual
//          surfaces, their own form can lead: the direction in which they turn from the eye.
// Inputs:  picture (RGBA8, sRGB-coded), clamped at the border; ids, normals (ArFrame) if
//          hasObjects; form: its weight.
// Outputs: RG16F: P cos 2θ, P sin 2θ, θ the gradient's direction; P is its length, of luma in [0,
//          1].
// Precision: highp for squares of small differences.
uniform sampler2D picture;
uniform highp usampler2D ids;
uniform sampler2D normals;
uniform bool hasObjects;
uniform float form;
layout(location = 0) out vec2 tensor;

#include "pipeline/gpu/shaders/luma.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"

float lumaAt(ivec2 at, ivec2 last) {
  return lumaOf(texelFetch(picture, clamp(at, ivec2(0), last), 0).rgb);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(picture, 0) - 1;
  float nw = lumaAt(p + ivec2(-1, -1), last);
  float n = lumaAt(p + ivec2(0, -1), last);
  float ne = lumaAt(p + ivec2(1, -1), last);
  float w = lumaAt(p + ivec2(-1, 0), last);
  float e = lumaAt(p + ivec2(1, 0), last);
  float sw = lumaAt(p + ivec2(-1, 1), last);
  float s = lumaAt(p + ivec2(0, 1), last);
  float se = lumaAt(p + ivec2(1, 1), last);
  vec2 g = vec2(ne + 2.0 * e + se - nw - 2.0 * w - sw, sw + 2.0 * s + se - nw - 2.0 * n - ne);
  float squared = dot(g, g);
  tensor = vec2(g.x * g.x - g.y * g.y, 2.0 * g.x * g.y) * inversesqrt(max(squared, 1e-12));
  if (hasObjects && isVirtual(objectOf(texelFetch(ids, p, 0).r))) {
    vec2 tilt = 2.0 * texelFetch(normals, p, 0).xy - 1.0;
    float steep = dot(tilt, tilt);
    tensor += form * vec2(tilt.x * tilt.x - tilt.y * tilt.y, 2.0 * tilt.x * tilt.y) *
              inversesqrt(max(steep, 1e-4));
  }
}
