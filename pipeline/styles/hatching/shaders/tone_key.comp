// Purpose: how much a dark picture is lightened, so that lines tell its darks apart: tones go
//          through l (1 + lighter) / (1 + lighter l), which brings the background's mean luma to
//          `least`. Nothing else is changed by what passes before it.
// Inputs:  halfTone (tone.frag, LINEAR); least: in (0, 1); most: of lightening; share: of the way to
//          this frame's value, in [0, 1].
// Outputs: lighter, 0 for pictures that are bright enough. One work group.
// Precision: highp; a fixed order of sums.
layout(local_size_x = 64) in;
layout(std430, binding = 0) buffer ToneKey { float lighter; };
uniform highp sampler2D halfTone;
uniform float least;
uniform float most;
uniform float share;

const ivec2 kGrid = ivec2(64, 48);  // of places that are looked at

shared vec4 sums[64];

void main() {
  uint me = gl_LocalInvocationIndex;
  vec4 sum = vec4(0.0);
  for (int row = 0; row < kGrid.y; ++row) {
    vec2 place = (vec2(float(me), float(row)) + 0.5) / vec2(kGrid);
    sum += textureLod(halfTone, place, 0.0);
  }
  sums[me] = sum;
  barrier();
  if (me != 0u) return;
  for (int i = 1; i < kGrid.x; ++i) sum += sums[i];
  // A picture of nothing but models has no background.
  vec2 seen = sum.y > 0.0 ? sum.xy : sum.zw;
  float mean = seen.x / max(seen.y, 1e-5);
  float goal = clamp((least - mean) / max(mean * (1.0 - least), 1e-5), 0.0, most);
  lighter = mix(lighter, goal, share);
}
