// Purpose: the direction of a set's lines: along the tensor field, or at one slope on the paper, or
//          in between, turned by the set's angle.
//          On a model, always along its own field, so that lines go with it; on a mover that goes
//          through the picture, whose field changes with every step, mostly at the slope, but on
//          somebody who moves in place as on the background.
// Inputs:  field, modelField (marks::TensorField), fieldScale; moverField, moverScale; displacements
//          (marks::MotionLayers), blockScale: blocks a px of the full image; goes: px of a
//          displacement from which on, and up to which, a mover goes; slope: a tensor;
//          lead: weight of the field beside it; turn: cosine and sine of the set's angle.
// Outputs: unit vectors; a direction and its opposite are the same.
// Precision: highp.
#include "pipeline/marks/movers/shaders/mover_displacement.glsl"
uniform highp sampler2D field;
uniform highp sampler2D modelField;
uniform highp sampler2D moverField;
uniform vec2 fieldScale;  // px of the full image to texture coordinates
uniform vec2 moverScale;
uniform highp sampler2D displacements;
uniform vec2 blockScale;
uniform vec2 goes;
uniform vec2 slope;
uniform float lead;
uniform vec2 turn;

const float kMoverLead = 0.1;  // part of lead, on a mover that goes

vec2 unitTensor(vec2 tensor) { return tensor * inversesqrt(max(dot(tensor, tensor), 1e-12)); }

// The part of lead at a place of a mover.
float moverLeadAt(vec2 px) {
  vec4 gone = texelFetch(displacements, min(ivec2(px * blockScale), textureSize(displacements, 0) - 1), 0);
  float going = mayBeInPlace(gone) ? smoothstep(goes.x, goes.y, length(gone.xy)) : 1.0;
  return mix(1.0, kMoverLead, going);
}

// `support`: of line_support.glsl.
vec2 directionAt(vec2 px, uint support) {
  bool isOnModel = support != 0u && support != kMoverLabel;
  vec2 tensor;
  if (isOnModel) {
    tensor = textureLod(modelField, px * fieldScale, 0.0).xy;
  } else if (support == 0u) {
    tensor = textureLod(field, px * fieldScale, 0.0).xy;
  } else {
    tensor = textureLod(moverField, px * moverScale, 0.0).xy;
    tensor = dot(tensor, tensor) > 1e-3 ? tensor : slope;
  }
  float weight = isOnModel ? 1.0 : support == 0u ? lead : moverLeadAt(px) * lead;
  tensor = unitTensor(mix(slope, unitTensor(tensor), weight));
  // Half the angle by square roots; lines run across the gradient.
  vec2 gradient = vec2(sqrt(max(0.0, 0.5 + 0.5 * tensor.x)), sqrt(max(0.0, 0.5 - 0.5 * tensor.x)));
  if (tensor.y < 0.0) gradient.y = -gradient.y;
  vec2 way = vec2(-gradient.y, gradient.x);
  return vec2(turn.x * way.x - turn.y * way.y, turn.y * way.x + turn.x * way.y);
}
