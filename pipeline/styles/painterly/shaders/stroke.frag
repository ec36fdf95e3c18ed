// Purpose: the paint that a brush leaves, and how thick it lies.
// Inputs:  brushes: R how much of the brush's paint is there, G its height; of the stroke, stroke.vert's.
// Outputs: 0: sRGB-coded colour, premultiplied, and its coverage; 1: height likewise, and in G how much
//          paint there is. To be blended
//          over what is there.
// Precision: mediump would do, but for places.
uniform sampler2D brushes;
in vec2 brush;
flat in vec4 paint;
flat in float aspect;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

const float kThinEnd = 1.2;  // widths

void main() {
  // The brush's ends keep their shape: a width of each end is the texture's first and last quarter.
  float cap = min(1.0, 0.5 * aspect);
  float fromStart = brush.x * aspect;
  float fromEnd = aspect - fromStart;
  float along = fromStart < cap ? 0.25 * fromStart / cap
                : fromEnd < cap ? 1.0 - 0.25 * fromEnd / cap
                                : 0.25 + 0.5 * (fromStart - cap) / max(aspect - 2.0 * cap, 1e-3);
  vec2 texel = texture(brushes, vec2(along, brush.y)).rg;
  float cover = paint.a * texel.r;
  // Little pigment on the ridge's sides, more in its furrows' shade: the colour goes with the height.
  vec3 tinted = paint.rgb * (0.94 + 0.12 * texel.g);
  colour = vec4(tinted * cover, cover);
  // At its ends paint goes over into what lies there: a step would be a seam across the stroke.
  float body = cover * smoothstep(0.0, kThinEnd, min(fromStart, fromEnd));
  height = vec4(texel.g * body, cover, 0.0, body);
}
