// Purpose: each pixel's edge as a tensor: the gradient by Sobel's operator (thesis eq. 5-8) in the
//          doubled angle (eq. 9), in which directions have no sign and can be added. Of luma and of
//          two differences of colours, whose squares are added (Di Zenzo, 1986): things of like
//          brightness have edges, too. The border of a virtual object is no edge of either side:
//          what is behind a model, or before the camera's picture, changes nothing about the other.
// Defines: has_objects.glsl's.
// Inputs:  picture (RGBA8, sRGB-coded), clamped at the border; ids (ArFrame) if hasObjects.
// Outputs: RG16F: P cos 2θ, P sin 2θ, θ the direction in which colours differ most; P: of grey
//          pictures, the length of the gradient of luma in [0, 1].
// Precision: highp for squares of small differences.
uniform sampler2D picture;
uniform highp usampler2D ids;
layout(location = 0) out vec2 tensor;

#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/scene/render/shaders/has_objects.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"

uint virtualAt(ivec2 at) {
  uint object = objectOf(texelFetch(ids, at, 0).r);
  return isVirtual(object) ? object : 0u;
}

struct Pixel {
  vec3 colour;  // as opponentOf() has it
  uint object;
};

const float kOpponents = 0.5;  // the weight of a difference of colours beside one of luma

const ivec2 kAround[8] = ivec2[8](ivec2(-1, -1), ivec2(0, -1), ivec2(1, -1), ivec2(-1, 0),
                                  ivec2(1, 0), ivec2(-1, 1), ivec2(0, 1), ivec2(1, 1));

// Luma, red against green, blue against both.
vec3 opponentOf(vec3 srgb) {
  vec2 opponents = vec2(srgb.r - srgb.g, srgb.b - 0.5 * (srgb.r + srgb.g));
  return vec3(lumaOf(srgb), kOpponents * opponents);
}

vec3 colourAt(ivec2 at, ivec2 last, Pixel own) {
  ivec2 there = clamp(at, ivec2(0), last);
  if (hasObjects && virtualAt(there) != own.object) return own.colour;
  return opponentOf(texelFetch(picture, there, 0).rgb);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(picture, 0) - 1;
  Pixel own = Pixel(vec3(0.0), 0u);
  if (hasObjects) own = Pixel(opponentOf(texelFetch(picture, p, 0).rgb), virtualAt(p));
  vec3 gx = vec3(0.0);
  vec3 gy = vec3(0.0);
  // One colour at a time: eight of them would take twice the registers.
  for (int i = 0; i < 8; ++i) {
    ivec2 arm = kAround[i];
    vec3 colour = colourAt(p + arm, last, own);
    gx += float(arm.x * (2 - abs(arm.y))) * colour;
    gy += float(arm.y * (2 - abs(arm.x))) * colour;
  }
  vec2 sum = vec2(dot(gx, gx) - dot(gy, gy), 2.0 * dot(gx, gy));
  tensor = sum * inversesqrt(max(length(sum), 1e-12));
}
