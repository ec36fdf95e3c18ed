// Purpose: the first half of a shadow's blur: along rows.
// Inputs:  map RG8 (from shadow_cast.frag); those of shadow_blur.glsl.
// Outputs: blurred RGBA8: the key light's shadow, the mean height of its casters, the ambient light's
//          shadow.
// Precision: highp; sums of 25.
#include "pipeline/scene/render/shaders/shadow_blur.glsl"

uniform sampler2D map;

layout(location = 0) out vec4 blurred;

void main() {
  ivec2 texel = ivec2(gl_FragCoord.xy);
  int width = textureSize(map, 0).x;
  float key = 0.0;
  float heights = 0.0;
  float contact = 0.0;
  int last = min(texel.x + kReach, width - 1);
  for (int x = max(texel.x - kReach, 0); x <= last; ++x) {
    vec2 caster = texelFetch(map, ivec2(x, texel.y), 0).rg;
    if (caster.r == 0.0) continue;
    float distance = abs(float(x - texel.x));
    float weight = keyWeight(distance, caster.g);
    float low = max(0.0, 1.0 - caster.g / contactHeight);
    key += weight;
    heights += weight * caster.g;
    contact += contactWeight(distance) * low;
  }
  blurred = vec4(min(key, 1.0), key > 0.0 ? heights / key : 0.0, min(contact, 1.0), 1.0);
}
