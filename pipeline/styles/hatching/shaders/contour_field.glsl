// Purpose: the direction of edges at a pixel, for contours.
// Inputs:  field, moverField (marks::TensorField, the finest level); fieldScale; mover_labels.glsl's;
//          size, pixelsOfFull: of the image.
// Outputs: the unit vector across the edge.
// Precision: highp.
uniform highp sampler2D field;
uniform highp sampler2D moverField;
uniform vec2 fieldScale;
uniform vec2 size;
uniform vec2 pixelsOfFull;

vec2 gradientAt(vec2 pixel) {
  vec2 px = pixel / pixelsOfFull;
  vec2 tensor = textureLod(field, px * fieldScale, 0.0).xy;
  float mover = moverAt(px).r;
  if (mover > 0.0) tensor = mix(tensor, textureLod(moverField, px * fieldScale, 0.0).xy, mover);
  tensor *= inversesqrt(max(dot(tensor, tensor), 1e-12));
  vec2 gradient = vec2(sqrt(max(0.0, 0.5 + 0.5 * tensor.x)), sqrt(max(0.0, 0.5 - 0.5 * tensor.x)));
  return vec2(gradient.x, tensor.y < 0.0 ? -gradient.y : gradient.y);
}
