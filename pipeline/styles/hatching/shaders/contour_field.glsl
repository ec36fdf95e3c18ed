// Purpose: the direction of edges at a pixel, for contours.
// Inputs:  field, modelField, moverField (marks::TensorField, the finest level); forms (ArFrame) if
//          hasForms; fieldScale; mover_labels.glsl's;
//          size, pixelsOfFull: of the image; fidelity.glsl's.
// Outputs: the unit vector across the edge, and how faithfully it is drawn.
// Precision: highp.
#include "pipeline/marks/shaders/fidelity.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
uniform highp sampler2D field;
uniform highp sampler2D modelField;
uniform highp sampler2D moverField;
uniform highp usampler2D forms;
uniform bool hasForms;
uniform vec2 fieldScale;
uniform vec2 size;
uniform vec2 pixelsOfFull;

bool isOnModel(vec2 pixel) {
  return hasForms && labelOf(texelFetch(forms, ivec2(pixel), 0).r) != 0u;
}

float fidelityOf(vec2 pixel) { return isOnModel(pixel) ? 0.0 : fidelityAt(pixel / pixelsOfFull); }

vec2 gradientAt(vec2 pixel) {
  vec2 px = pixel / pixelsOfFull;
  vec2 tensor = textureLod(field, px * fieldScale, 0.0).xy;
  float mover = moverAt(px).r;
  if (mover > 0.0) tensor = mix(tensor, textureLod(moverField, px * fieldScale, 0.0).xy, mover);
  if (isOnModel(pixel)) tensor = textureLod(modelField, px * fieldScale, 0.0).xy;
  tensor *= inversesqrt(max(dot(tensor, tensor), 1e-12));
  vec2 gradient = vec2(sqrt(max(0.0, 0.5 + 0.5 * tensor.x)), sqrt(max(0.0, 0.5 - 0.5 * tensor.x)));
  return vec2(gradient.x, tensor.y < 0.0 ? -gradient.y : gradient.y);
}
