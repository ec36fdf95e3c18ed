// Purpose: what of the image belongs to movers, where their shares are all that is read of labels.
// Inputs:  mover_shares.glsl's.
// Outputs: mover: in [0, 1]; mover_near.glsl's.
// Precision: highp.
#include "pipeline/marks/movers/shaders/mover_shares.glsl"

vec2 moverAt(vec2 px) { return vec2(sumOf(sharesAt(px)), 0.0); }

#include "pipeline/marks/movers/shaders/mover_near.glsl"

// Whether another mover than this one is within `reach` px.
bool isNearAnother(vec2 px, int number, float reach) {
  for (int i = 0; i < 5; ++i) {
    vec2 arm = i == 4 ? vec2(0.0) : (i & 1) == 0 ? vec2(reach, 0.0) : vec2(0.0, reach);
    vec3 shares = sharesAt(px + ((i & 2) == 0 ? arm : -arm));
    if (sumOf(shares) - shareOf(shares, number) > 0.25) return true;
  }
  return false;
}
