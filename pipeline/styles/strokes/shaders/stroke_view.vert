// Purpose: debug views of strokes: whole, as skeletons, or as anchors.
// Inputs:  stroke_spline.glsl's; fullSize: px; view: as stroke_view.frag.
// Outputs: across: in [-1, 1]; paint; age: of the anchor, s.
// Precision: highp.
#include "pipeline/styles/strokes/shaders/stroke_spline.glsl"
uniform vec2 fullSize;
uniform int view;
out float across;
flat out vec4 paint;
flat out float age;

void main() {
  SplinePlace place = splinePlace();
  float side = (gl_VertexID & 1) == 0 ? -1.0 : 1.0;
  float reach = view == VIEW_SKELETONS ? 0.8 : shape.x;
  vec2 at = place.at + side * reach * vec2(-place.along.y, place.along.x);
  if (view == VIEW_ANCHORS) {
    vec2 middle = 0.5 * (second.zw + third.xy);
    at = middle + 2.0 * vec2(2.0 * place.part - 1.0, side);
  }
  across = side;
  paint = strokePaint;
  age = shape.w;
  gl_Position = vec4(2.0 * at / fullSize - 1.0, 0.0, 1.0);
}
