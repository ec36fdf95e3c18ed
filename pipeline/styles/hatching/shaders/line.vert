// Purpose: the vertices of hatching lines.
// Inputs:  vertices of stroke_strips.comp with LONG; fullSize: px.
// Outputs: brush: along and across the line, in [0, 1]; shape: half of its width here and its
//          length, px; paint; label: of what it lies on; variant: of the brush.
// Precision: highp.
layout(location = 0) in vec2 at;
layout(location = 1) in vec2 brushAt;
layout(location = 3) in vec4 strokePaint;
layout(location = 4) in vec2 strokeShape;
layout(location = 5) in uint strokeObject;
uniform vec2 fullSize;
out vec2 brush;
out vec2 shape;
flat out vec4 paint;
flat out uint label;
flat out uint variant;

void main() {
  brush = brushAt;
  shape = strokeShape;
  paint = strokePaint;
  label = strokeObject & 0xFFFFu;
  variant = strokeObject >> 16u;
  gl_Position = vec4(2.0 * at / fullSize - 1.0, 0.0, 1.0);
}
