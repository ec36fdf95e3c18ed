// Purpose: what the edges of movers say about their motion, in blocks of cells. Along an edge,
//          motion is not seen (the aperture problem): dense flow is 0 along a sleeve's outline,
//          however fast the arm goes.
// Inputs:  labels, picture: this frame's, in cells; motion_layers.glsl's, flow backward;
//          mover_motion.glsl's, of the previous frame, and motionScale, this step over that.
// Outputs: normals RGBA16F: the sum over edges of w n nᵀ (xx, xy, yy), n the edge's normal;
//          and how many of the block's cells are a mover's.
//          normalFlow RGBA16F: the sum of w n (n · d), d the flow's displacement since the previous
//          frame, less the background's, px of the full image. w falls with the flow's error, and
//          where the flow has remained with the background. One invocation per block of
//          kLayerBlock² cells.
// Precision: highp.
#include "pipeline/gpu/shaders/luma.glsl"
#include "pipeline/marks/shaders/layer_blocks.glsl"
#include "pipeline/marks/shaders/motion_layers.glsl"
#include "pipeline/marks/shaders/mover_motion.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D normals;
layout(rgba16f, binding = 1) writeonly uniform highp image2D normalFlow;
uniform highp sampler2D labels;
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

void main() {
  ivec2 block = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(block, imageSize(normals)))) return;
  ivec2 first = block * kLayerBlock;
  ivec2 size = textureSize(labels, 0);
  vec3 matrix = vec3(0.0);
  vec2 moved = vec2(0.0);
  float cells = 0.0;
  for (int y = 0; y < kLayerBlock; y += kStep) {
    for (int x = 0; x < kLayerBlock; x += kStep) {
      ivec2 cell = first + ivec2(x, y);
      if (any(greaterThanEqual(cell, size))) continue;
      if (texelFetch(labels, cell, 0).r < 0.5) continue;
      cells += float(kStep * kStep);
      vec2 gradient = vec2(lumaAt(cell + ivec2(2, 0), size) - lumaAt(cell - ivec2(2, 0), size),
                           lumaAt(cell + ivec2(0, 2), size) - lumaAt(cell - ivec2(0, 2), size));
      float weight = smoothstep(kContrast.x, kContrast.y, length(gradient));
      if (weight <= 0.0) continue;
      vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
      Moved flowed = byFlow(px);
      if (!(flowed.error <= kMaxError)) continue;
      weight /= 0.25 + flowed.error * flowed.error;
      vec2 n = normalize(gradient);
      float along = dot(n, -flowed.displacement - backgroundShift(px));
      vec2 expected;
      if (findMoverMotion(px, expected)) weight *= trustIn(along, motionScale * dot(n, expected));
      matrix += weight * vec3(n.x * n.x, n.x * n.y, n.y * n.y);
      moved += weight * along * n;
    }
  }
  imageStore(normals, block, vec4(matrix, cells));
  imageStore(normalFlow, block, vec4(moved, 0.0, 0.0));
}
