// Purpose: the second half of a shadow's blur: along columns. Fades at the map's edge.
// Inputs:  map RGBA8 (from shadow_blur_across.frag); those of shadow_blur.glsl.
// Outputs: kept RG8: the blocked share of the key light and of the ambient light.
// Precision: highp; sums of 25.
#include "pipeline/scene/render/shaders/shadow_blur.glsl"

uniform sampler2D map;

layout(location = 0) out vec2 kept;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  ivec2 size = textureSize(map, 0);
  float key = 0.0;
  float contact = 0.0;
  int last = min(texel.y + kReach, size.y - 1);
  for (int y = max(texel.y - kReach, 0); y <= last; ++y) {
    vec3 row = texelFetch(map, ivec2(texel.x, y), 0).rgb;
    float distance = abs(float(y - texel.y));
    key += keyWeight(distance, row.g) * row.r;
    contact += contactWeight(distance) * row.b;
  }
  vec2 fromRim = 0.5 - abs(gl_FragCoord.xy / vec2(size) - 0.5);
  float fade = smoothstep(0.0, 0.06, min(fromRim.x, fromRim.y));
  kept = fade * min(vec2(key, contact), 1.0);
}
