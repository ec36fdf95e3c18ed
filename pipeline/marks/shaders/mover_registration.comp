// Purpose: how this frame's movers lie on those of the previous frame, in blocks of cells, once
//          their motion is roughly known (mover_motion.comp): one step of Lucas and Kanade ("An
//          iterative image registration technique", 1981) over what is within a mover in both
//          frames, and over its silhouette. Dense flow compares patches, which beside an outline hold
//          the background too, and so falls short of a mover's motion.
// Inputs:  mover_shares.glsl's and picture: this frame's, in cells; lastShares, lastPicture: the
//          previous frame's; mover_motion.glsl's, of this frame; motion_layers.glsl's; edges,
//          edgeFlow: normals and normalFlow of mover_edges.comp or of the step before; noise: sigma of a cell's
//          colour, in [0, 1].
// Outputs: normals, normalFlow: as of mover_edges.comp, n the gradient's direction and d the
//          displacement that takes away the difference. One invocation per block of kLayerBlock²
//          cells.
// Precision: highp.
#include "pipeline/marks/shaders/layer_blocks.glsl"
#include "pipeline/marks/shaders/motion_layers.glsl"
#include "pipeline/marks/shaders/mover_motion.glsl"
#include "pipeline/marks/shaders/mover_shares.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D normals;
layout(rgba16f, binding = 1) writeonly uniform highp image2D normalFlow;
uniform highp sampler2D edges;
uniform highp sampler2D edgeFlow;
uniform highp sampler2D picture;
uniform highp sampler2D lastPicture;
uniform highp sampler2D lastShares;
uniform float noise;

const float kArm = 2.0 * kLayerCellPixels;  // px, of central differences
const vec2 kContrast = vec2(0.03, 0.1);     // over two arms: from no edge to a clear one
const vec2 kNoisyContrast = vec2(5.0, 15.0);  // the same in deviations of noise, if that is more
const float kSlope = 0.3;                   // of shares over two arms: an outline
const float kWithin = 0.95;                 // of a mover's share: surely within it
const float kBesideAnother = 0.25;          // of another mover's share: the outline may be its
const float kFarthest = 4.0;                // px of displacement in one step
const float kSilhouette = 0.4;              // weight of a cell of the outline: labels err by a pixel
const float kColour = 2.0;                  // weight of a clear edge within

// The share of a mover of the four cells around the lower right corner of a cell's place.
float shareAround(highp sampler2D shares, vec2 px, int number) {
  return shareOf(textureLod(shares, inLayers(shares, px + 0.5 * kLayerCellPixels), 0.0).rgb, number);
}

// Whether another mover is within two arms: one of the two hides the other's outline.
bool isNearAnother(vec2 px, int number) {
  for (int i = 0; i < 4; ++i) {
    vec2 arm = (i & 1) == 0 ? vec2(2.0 * kArm, 0.0) : vec2(0.0, 2.0 * kArm);
    vec3 shares = sharesAt((i & 2) == 0 ? px + arm : px - arm);
    if (sumOf(shares) - shareOf(shares, number) > kBesideAnother) return true;
  }
  return false;
}

vec3 colourAt(highp sampler2D cells, vec2 px) { return textureLod(cells, inLayers(cells, px), 0.0).rgb; }

struct Sum {
  vec3 matrix;
  vec2 moved;
};

// `along`: the displacement along the gradient that is left.
void add(inout Sum sum, vec2 gradient, float along, vec2 displacement, float weight) {
  float len = length(gradient);
  vec2 n = gradient / len;
  weight /= 1.0 + 0.1 * along * along;  // what is far off is something else
  sum.matrix += weight * vec3(n.x * n.x, n.x * n.y, n.y * n.y);
  sum.moved += weight * (dot(n, displacement) + clamp(along, -kFarthest, kFarthest)) * n;
}

// Whether an outline like that at px, with the mover on the side of `inwards`, was near `back`.
bool hadOutline(vec2 back, vec2 inwards, int number) {
  vec2 reach = (kArm + kFarthest) * inwards;
  return shareAround(lastShares, back + reach, number) > 0.5 &&
         shareAround(lastShares, back - reach, number) < 0.5;
}

void addCell(inout Sum sum, vec2 px, int number, vec2 displacement) {
  vec2 back = px - backgroundShift(px) - displacement;
  if (!isInPicture(back - 2.0 * kArm) || !isInPicture(back + 2.0 * kArm)) return;
  if (!isInPicture(px - 2.0 * kArm) || !isInPicture(px + 2.0 * kArm)) return;
  vec4 shares = vec4(shareAround(moverShares, px + vec2(kArm, 0.0), number),
                     shareAround(moverShares, px - vec2(kArm, 0.0), number),
                     shareAround(moverShares, px + vec2(0.0, kArm), number),
                     shareAround(moverShares, px - vec2(0.0, kArm), number));
  float least = min(min(shares.x, shares.y), min(shares.z, shares.w));
  float own = shareAround(moverShares, px, number);
  float was = shareAround(lastShares, back, number);
  vec2 slope = vec2(shares.x - shares.y, shares.z - shares.w);
  // Beyond the outline's ramp, both are the same wherever it is.
  bool isOnRamp = min(own, was) < kWithin && max(own, was) > 1.0 - kWithin;
  if (length(slope) > kSlope && isOnRamp && !isNearAnother(px, number) &&
      hadOutline(back, normalize(slope), number)) {
    add(sum, slope, 2.0 * kArm * (was - own) / length(slope), displacement, kSilhouette);
  }
  if (min(least, min(own, was)) < kWithin) return;
  vec3 right = colourAt(picture, px + vec2(kArm, 0.0)) - colourAt(picture, px - vec2(kArm, 0.0));
  vec3 down = colourAt(picture, px + vec2(0.0, kArm)) - colourAt(picture, px - vec2(0.0, kArm));
  vec3 change = colourAt(lastPicture, back) - colourAt(picture, px);
  vec2 contrast = max(kContrast, kNoisyContrast * noise);
  for (int c = 0; c < 3; ++c) {
    vec2 gradient = vec2(right[c], down[c]);
    float weight = kColour / 3.0 * smoothstep(contrast.x, contrast.y, length(gradient));
    if (weight <= 0.0) continue;
    add(sum, gradient, 2.0 * kArm * change[c] / length(gradient), displacement, weight);
  }
}

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  ivec2 blocks = ivec2(imageSize(normals).x, imageSize(normals).y / kMostMovers);
  if (any(greaterThanEqual(block, blocks))) return;
  ivec2 first = block * kLayerBlock;
  ivec2 size = min(textureSize(moverShares, 0) - first, ivec2(kLayerBlock));
  int present = int(texelFetch(edgeFlow, block, 0).z + 0.5);
  for (int number = 1; number <= kMostMovers; ++number) {
    ivec2 at = block + ivec2(0, (number - 1) * blocks.y);
    float cells = texelFetch(edges, at, 0).a;
    Sum sum = Sum(vec3(0.0), vec2(0.0));
    vec2 displacement;
    vec2 middle = (vec2(block) + 0.5) * float(kLayerBlock) * kLayerCellPixels;
    bool isHere = (present & (1 << (number - 1))) != 0 && findMoverMotion(middle, number, displacement);
    int count = isHere ? size.x * size.y : 0;
    for (int i = 0; i < count; ++i) {
      vec2 cell = vec2(first + ivec2(i % size.x, i / size.x)) + 0.5;
      addCell(sum, cell * kLayerCellPixels, number, displacement);
    }
    imageStore(normals, at, vec4(sum.matrix, cells));
    imageStore(normalFlow, at, vec4(sum.moved, number == 1 ? float(present) : 0.0, 0.0));
  }
}
