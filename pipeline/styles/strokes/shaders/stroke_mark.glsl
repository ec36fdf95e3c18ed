// Purpose: the mark of a brush, at a fragment of a stroke.
// Inputs:  brushes: R coverage of the brush's paint, G its height; stroke.vert's of the stroke.
// Outputs: 0: sRGB-coded colour, premultiplied, and its coverage; 1: height, premultiplied, and in
//          G the amount of paint. To be blended over the existing paint.
// Precision: mediump suffices, except for places.
uniform sampler2D brushes;
in vec2 brush;
flat in vec4 paint;
flat in float aspect;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

const float kThinEnd = 1.2;  // widths

// The brush's ends keep their shape: a width of each end takes the texture's first and last
// quarter.
vec2 brushPlace() {
  float cap = min(1.0, 0.5 * aspect);
  float fromStart = brush.x * aspect;
  float fromEnd = aspect - fromStart;
  float onward = fromStart < cap ? 0.25 * fromStart / cap
                 : fromEnd < cap ? 1.0 - 0.25 * fromEnd / cap
                                 : 0.25 + 0.5 * (fromStart - cap) / max(aspect - 2.0 * cap, 1e-3);
  return vec2(onward, brush.y);
}

// Less pigment on the sides of ridges, more in the shade of furrows: the colour follows the height.
vec3 pigment(float thick) { return paint.rgb * (0.94 + 0.12 * thick); }

void leave(vec3 rgb, float thick, float cover) {
  colour = vec4(rgb * cover, cover);
  // At its ends the paint fades into the paint below; a step would be a seam across the stroke.
  float fromEnds = aspect * min(brush.x, 1.0 - brush.x);
  float body = cover * smoothstep(0.0, kThinEnd, fromEnds);
  height = vec4(thick * body, body, 0.0, body);
}
