// Purpose: which of the movers a place belongs to (marks::MotionLayers::shares).
// Inputs:  moverShares; places in px of the full image.
// Outputs: shares of the movers 1 to kMostMovers, in [0, 1] each; their sum is the share of all.
// Precision: highp for places.
#include "pipeline/marks/movers/shaders/layer_cells.glsl"
uniform highp sampler2D moverShares;

const int kMostMovers = 3;

vec3 sharesAt(vec2 px) { return textureLod(moverShares, inLayers(moverShares, px), 0.0).rgb; }

// The number of the mover whose cell this is, 0 if it is none's.
int numberAt(vec2 px) {
  ivec2 last = textureSize(moverShares, 0) - 1;
  vec3 shares = texelFetch(moverShares, clamp(ivec2(px / kLayerCellPixels), ivec2(0), last), 0).rgb;
  return shares.r > 0.5 ? 1 : shares.g > 0.5 ? 2 : shares.b > 0.5 ? 3 : 0;
}

float sumOf(vec3 shares) { return shares.r + shares.g + shares.b; }

float shareOf(vec3 shares, int number) {
  return number == 1 ? shares.r : number == 2 ? shares.g : shares.b;
}

// The mover with the largest share, 0 if there is none.
int numberOf(vec3 shares) {
  if (sumOf(shares) <= 0.0) return 0;
  return shares.r >= max(shares.g, shares.b) ? 1 : shares.g >= shares.b ? 2 : 3;
}
