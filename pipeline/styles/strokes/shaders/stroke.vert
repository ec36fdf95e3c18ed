// Purpose: the vertices of painted strokes.
// Inputs:  stroke_strips.comp's vertices; fullSize: px.
// Outputs: brush: along and across the stroke, in [0, 1] and in the brush's variant; along: the
//          stroke's direction, px; paint; aspect: the stroke's length by its width; sense: its sign is
//          the brush's across the stroke, its size the drawn width by the stroke's; label: of what the
//          stroke lies on.
// Precision: highp.
layout(location = 0) in vec2 at;
layout(location = 1) in vec2 brushAt;
layout(location = 2) in vec2 direction;
layout(location = 3) in vec4 strokePaint;
layout(location = 4) in vec2 shape;
layout(location = 5) in uint strokeLabel;
uniform vec2 fullSize;
out vec2 brush;
out vec2 along;
flat out vec4 paint;
flat out float aspect;
flat out float sense;
flat out uint label;

void main() {
  brush = brushAt;
  along = direction;
  paint = strokePaint;
  aspect = shape.x;
  sense = shape.y;
  label = strokeLabel;
  gl_Position = vec4(2.0 * at / fullSize - 1.0, 0.0, 1.0);
}
