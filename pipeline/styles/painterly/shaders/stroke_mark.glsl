// Purpose: the mark that a brush leaves, at a fragment of a stroke.
// Inputs:  brushes: R how much of the brush's paint is there, G its height; of the stroke, stroke.vert's.
// Outputs: 0: sRGB-coded colour, premultiplied, and its coverage; 1: height likewise, and in G how much
//          paint there is. To be blended over what is there.
// Precision: mediump would do, but for places.
uniform sampler2D brushes;
in vec2 brush;
flat in vec4 paint;
flat in float aspect;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

const float kThinEnd = 1.2;  // widths

// The brush's ends keep their shape: a width of each end is the texture's first and last quarter.
vec2 brushPlace() {
  float cap = min(1.0, 0.5 * aspect);
  float fromStart = brush.x * aspect;
  float fromEnd = aspect - fromStart;
  float onward = fromStart < cap ? 0.25 * fromStart / cap
                 : fromEnd < cap ? 1.0 - 0.25 * fromEnd / cap
                                 : 0.25 + 0.5 * (fromStart - cap) / max(aspect - 2.0 * cap, 1e-3);
  return vec2(onward, brush.y);
}

// Little pigment on the ridge's sides, more in its furrows' shade: the colour goes with the height.
vec3 pigment(float thick) { return paint.rgb * (0.94 + 0.12 * thick); }

void leave(vec3 rgb, float thick, float cover) {
  colour = vec4(rgb * cover, cover);
  // At its ends paint goes over into what lies there: a step would be a seam across the stroke.
  float fromEnds = aspect * min(brush.x, 1.0 - brush.x);
  float body = cover * smoothstep(0.0, kThinEnd, fromEnds);
  height = vec4(thick * body, body, 0.0, body);
}
