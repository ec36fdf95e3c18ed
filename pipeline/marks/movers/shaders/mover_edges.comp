// Purpose: what the edges of movers say about their motion, in blocks of cells. Along an edge,
//          motion is not seen (the aperture problem): dense flow is 0 along a sleeve's outline,
//          however fast the arm goes.
// Inputs:  mover_shares.glsl's, picture: this frame's, in cells; motion_layers.glsl's, flow backward;
//          mover_motion.glsl's, of the previous frame, and motionScale, this step over that;
//          busy_blocks.glsl's commands.
// Outputs: normals RGBA16F: the sum over edges of w n nᵀ (xx, xy, yy), n the edge's normal;
//          and how many of the block's cells are the mover's. The movers' blocks are one above the other.
//          normalFlow RGBA16F: the sum of w n (n · d), d the flow's displacement since the previous
//          frame, less the background's, px of the full image. w falls with the flow's error, and
//          where the flow has remained with the background. In the first mover's, B: which movers
//          are in the block, a bit for each. Edges between two movers tell nothing. One invocation
//          per block of kLayerBlock² cells.
// Precision: highp.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers.glsl"
#include "pipeline/marks/movers/shaders/mover_motion.glsl"
#include "pipeline/marks/movers/shaders/mover_shares.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D normals;
layout(rgba16f, binding = 1) writeonly uniform highp image2D normalFlow;
uniform highp sampler2D picture;
uniform float motionScale;

const int kStep = 2;  // cells
const float kMaxError = 3.0;  // px
const vec2 kContrast = vec2(0.03, 0.1);  // luma over four cells: from no edge to a clear one

// How far an edge's motion is to be trusted, if the mover's was `expected`. Beside a mover, flow
// errs towards the background's.
float trustIn(float along, float expected) {
  const float kSlack = 0.5;  // px
  float missing = max(abs(expected) - max(along * sign(expected), 0.0) - kSlack, 0.0);
  return 1.0 / (1.0 + 4.0 * missing * missing);
}

float lumaAt(ivec2 cell, ivec2 size) {
  return lumaOf(texelFetch(picture, clamp(cell, ivec2(0), size - 1), 0).rgb);
}

int numberIn(ivec2 cell, ivec2 size) {
  vec3 shares = texelFetch(moverShares, clamp(cell, ivec2(0), size - 1), 0).rgb;
  return shares.r > 0.5 ? 1 : shares.g > 0.5 ? 2 : shares.b > 0.5 ? 3 : 0;
}

// Whether a cell of a mover is beside another mover.
bool isBesideAnother(ivec2 cell, ivec2 size, int number) {
  const int kReach = 3;  // cells
  for (int i = 0; i < 4; ++i) {
    ivec2 arm = (i & 1) == 0 ? ivec2(kReach, 0) : ivec2(0, kReach);
    int there = numberIn(cell + ((i & 2) == 0 ? arm : -arm), size);
    if (there != 0 && there != number) return true;
  }
  return false;
}

void main() {
  if (isBeyond(kMotionCommand)) return;
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  ivec2 blocks = ivec2(imageSize(normals).x, imageSize(normals).y / kMostMovers);
  if (any(greaterThanEqual(block, blocks))) return;
  ivec2 first = block * kLayerBlock;
  ivec2 size = textureSize(moverShares, 0);
  int present = 0;  // a bit for each mover
  for (int y = 0; y < kLayerBlock; y += kStep) {
    for (int x = 0; x < kLayerBlock; x += kStep) {
      present |= 1 << numberIn(first + ivec2(x, y), size);
    }
  }
  for (int number = 1; number <= kMostMovers; ++number) {
    vec3 matrix = vec3(0.0);
    vec2 moved = vec2(0.0);
    float cells = 0.0;
    bool isHere = (present & (1 << number)) != 0;
    for (int i = isHere ? 0 : kLayerBlock * kLayerBlock; i < kLayerBlock * kLayerBlock; i += kStep) {
      // Every kStep-th cell of every kStep-th row.
      ivec2 in_ = ivec2(i % kLayerBlock, i / kLayerBlock);
      if (in_.y % kStep != 0) continue;
      ivec2 cell = first + in_;
      if (any(greaterThanEqual(cell, size)) || numberIn(cell, size) != number) continue;
      cells += float(kStep * kStep);
      vec2 gradient = vec2(lumaAt(cell + ivec2(2, 0), size) - lumaAt(cell - ivec2(2, 0), size),
                           lumaAt(cell + ivec2(0, 2), size) - lumaAt(cell - ivec2(0, 2), size));
      float weight = smoothstep(kContrast.x, kContrast.y, length(gradient));
      if (weight <= 0.0 || isBesideAnother(cell, size, number)) continue;
      vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
      Moved flowed = byFlow(px);
      if (!(flowed.error <= kMaxError)) continue;
      weight /= 0.25 + flowed.error * flowed.error;
      vec2 n = normalize(gradient);
      float along = dot(n, -flowed.displacement - backgroundShift(px));
      vec2 expected;
      if (findMoverMotion(px, number, expected)) {
        weight *= trustIn(along, motionScale * dot(n, expected));
      }
      matrix += weight * vec3(n.x * n.x, n.x * n.y, n.y * n.y);
      moved += weight * along * n;
    }
    ivec2 at = block + ivec2(0, (number - 1) * blocks.y);
    imageStore(normals, at, vec4(matrix, cells));
    imageStore(normalFlow, at, vec4(moved, float(present >> 1), 0.0));
  }
}
