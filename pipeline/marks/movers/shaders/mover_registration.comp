// Purpose: how this frame's movers lie on those of the previous frame, in blocks of cells, once
//          their motion is roughly known (mover_motion.comp): one step of Lucas and Kanade ("An
//          iterative image registration technique", 1981) over what is within a mover in both
//          frames, and over its silhouette. Dense flow compares patches, which beside an outline hold
//          the background too, and so falls short of a mover's motion.
// Inputs:  mover_shares.glsl's and picture: this frame's, in cells; lastShares, lastPicture: the
//          previous frame's; mover_motion.glsl's, of this frame; motion_layers.glsl's; edges,
//          edgeFlow: normals and normalFlow of mover_edges.comp or of the step before; noise: sigma of a cell's
//          colour, in [0, 1]; busy_blocks.glsl's commands.
// Outputs: normals, normalFlow: as of mover_edges.comp, n the gradient's direction and d the
//          displacement that takes away the difference. One invocation per block of kLayerBlock²
//          cells.
// Precision: highp.
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
#include "pipeline/marks/movers/shaders/mover_shares.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D normals;
layout(rgba16f, binding = 1) writeonly uniform highp image2D normalFlow;
uniform highp sampler2D edges;
uniform highp sampler2D edgeFlow;
uniform highp sampler2D picture;
uniform highp sampler2D lastPicture;
uniform highp sampler2D lastShares;
uniform float noise;
uniform int arms;  // 4, the places around; a uniform, so that compilers keep the loop over them

const float kArm = 2.0 * kLayerCellPixels;  // px, of central differences
const vec2 kContrast = vec2(0.004, 0.03);  // over two arms: from no edge to a clear one
const vec2 kNoisyContrast = vec2(2.5, 8.0);  // the same in deviations of noise, if that is more
const float kSlope = 0.3;                   // of shares over two arms: an outline
const float kWithin = 0.95;                 // of a mover's share: surely within it
const float kAnother = 0.25;                // of other movers' shares: the outline may be theirs
const float kFarthest = 4.0;                // px of displacement in one step
const float kSilhouette = 0.17;             // weight of a cell of the outline: labels err by a pixel
const float kColour = 2.0;                  // weight of a clear edge within

// The shares of a mover and of all others of the four cells around the lower right corner of a
// cell's place.
vec2 sharesAround(highp sampler2D shares, vec2 px, int number) {
  vec3 all = textureLod(shares, inLayers(shares, px + 0.5 * kLayerCellPixels), 0.0).rgb;
  float own = shareOf(all, number);
  return vec2(own, sumOf(all) - own);
}

vec3 colourAt(highp sampler2D cells, vec2 px) { return textureLod(cells, inLayers(cells, px), 0.0).rgb; }

struct Sum {
  vec3 matrix;
  vec2 moved;
};

// `along`: the displacement along the gradient that is left.
void add(inout Sum sum, vec2 gradient, float along, float weight) {
  float len = length(gradient);
  vec2 n = gradient / len;
  weight /= 1.0 + 0.1 * along * along;  // what is far off is something else
  sum.matrix += weight * vec3(n.x * n.x, n.x * n.y, n.y * n.y);
  sum.moved += weight * clamp(along, -kFarthest, kFarthest) * n;
}

// Whether the mover was where its inside was, from an outline near `back`.
bool wasThere(vec2 back, vec2 inwards, int number) {
  return sharesAround(lastShares, back + (kArm + kFarthest) * inwards, number).x > 0.5;
}

void addCell(inout Sum sum, vec2 px, int number, vec2 displacement) {
  vec2 back = px - backgroundShift(px) - displacement;
  if (!isInPicture(back - 2.0 * kArm) || !isInPicture(back + 2.0 * kArm)) return;
  if (!isInPicture(px - 2.0 * kArm) || !isInPicture(px + 2.0 * kArm)) return;
  vec2 slope = vec2(0.0);
  float least = 1.0;
  float another = 0.0;
  for (int i = 0; i < arms; ++i) {
    vec2 side = (i < 2 ? vec2(1.0, 0.0) : vec2(0.0, 1.0)) * float(1 - 2 * (i & 1));
    vec2 there = sharesAround(moverShares, px + kArm * side, number);
    slope += there.x * side;
    least = min(least, there.x);
    another = max(another, there.y);
  }
  float own = sharesAround(moverShares, px, number).x;
  float was = sharesAround(lastShares, back, number).x;
  // Beyond the outline's ramp, both are the same wherever it is.
  bool isOnRamp = min(own, was) < kWithin && max(own, was) > 1.0 - kWithin;
  if (length(slope) > kSlope && isOnRamp && another < kAnother &&
      wasThere(back, normalize(slope), number)) {
    add(sum, slope, 2.0 * kArm * (was - own) / length(slope), kSilhouette);
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
    add(sum, gradient, 2.0 * kArm * change[c] / length(gradient), weight);
  }
}

void main() {
  if (isBeyond(kMotionCommand)) return;
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
    vec2 moved = sum.moved;
    if (isHere) moved += mat2(sum.matrix.xy, sum.matrix.yz) * displacement;
    imageStore(normals, at, vec4(sum.matrix, cells));
    imageStore(normalFlow, at, vec4(moved, number == 1 ? float(present) : 0.0, 0.0));
  }
}
