// Purpose: each pixel's edge as a tensor: the gradient by Sobel's operator (thesis eq. 5-8) in the
//          doubled angle (eq. 9), in which directions have no sign and can be added. The border of
//          a virtual object is no edge of either side: what is behind a model, or before the
//          camera's picture, changes nothing about the other.
// Defines: has_objects.glsl's.
// Inputs:  picture (RGBA8, sRGB-coded), clamped at the border; ids (ArFrame) if hasObjects.
// Outputs: RG16F: P cos 2θ, P sin 2θ, θ the gradient's direction; P is its length, of luma in [0,
//          1].
// Precision: highp for squares of small differences.
uniform sampler2D picture;
uniform highp usampler2D ids;
layout(location = 0) out vec2 tensor;

#include "pipeline/gpu/shaders/luma.glsl"
#include "pipeline/scene/render/shaders/has_objects.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"

uint virtualAt(ivec2 at) {
  uint object = objectOf(texelFetch(ids, at, 0).r);
  return isVirtual(object) ? object : 0u;
}

struct Pixel {
  float luma;
  uint object;
};

float lumaAt(ivec2 at, ivec2 last, Pixel own) {
  ivec2 there = clamp(at, ivec2(0), last);
  if (hasObjects && virtualAt(there) != own.object) return own.luma;
  return lumaOf(texelFetch(picture, there, 0).rgb);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(picture, 0) - 1;
  Pixel own = Pixel(0.0, 0u);
  if (hasObjects) own = Pixel(lumaOf(texelFetch(picture, p, 0).rgb), virtualAt(p));
  float nw = lumaAt(p + ivec2(-1, -1), last, own);
  float n = lumaAt(p + ivec2(0, -1), last, own);
  float ne = lumaAt(p + ivec2(1, -1), last, own);
  float w = lumaAt(p + ivec2(-1, 0), last, own);
  float e = lumaAt(p + ivec2(1, 0), last, own);
  float sw = lumaAt(p + ivec2(-1, 1), last, own);
  float s = lumaAt(p + ivec2(0, 1), last, own);
  float se = lumaAt(p + ivec2(1, 1), last, own);
  vec2 g = vec2(ne + 2.0 * e + se - nw - 2.0 * w - sw, sw + 2.0 * s + se - nw - 2.0 * n - ne);
  float squared = dot(g, g);
  tensor = vec2(g.x * g.x - g.y * g.y, 2.0 * g.x * g.y) * inversesqrt(max(squared, 1e-12));
}
