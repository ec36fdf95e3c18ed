// Purpose: how much a dark picture is lightened, so that lines tell its darks apart: luma l becomes
//          l (1 + lightening) / (1 + lightening l), which takes the background's mean luma to
//          `least`. What is before the background hardly counts.
// Inputs:  halfTone (tone.frag, LINEAR); least: in (0, 1); most: of lightening; share: of the way to
//          this frame's value, in [0, 1].
// Outputs: lightening, 0 for pictures that are bright enough. One work group.
// Precision: highp; a fixed order of sums.
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer ToneLightening { float lightening; };
uniform highp sampler2D halfTone;
uniform float least;
uniform float most;
uniform float share;

const ivec2 kGrid = ivec2(64, 48);  // of places that are looked at
const float kFront = 0.02;  // its weight: a picture may show nothing else

shared vec2 sums[64];

void main() {
  uint me = gl_LocalInvocationIndex;
  vec4 sum = vec4(0.0);
  for (int row = 0; row < kGrid.y; ++row) {
    vec2 place = (vec2(float(me), float(row)) + 0.5) / vec2(kGrid);
    sum += textureLod(halfTone, place, 0.0);
  }
  vec2 seen = sum.xy + kFront * sum.zw;
  sums[me] = seen;
  barrier();
  if (me != 0u) return;
  for (int i = 1; i < kGrid.x; ++i) seen += sums[i];
  float mean = seen.x / max(seen.y, 1e-5);
  float now = clamp((least - mean) / max(mean * (1.0 - least), 1e-5), 0.0, most);
  lightening = mix(lightening, now, share);
}
