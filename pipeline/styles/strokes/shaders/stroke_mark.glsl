// Purpose: the mark of a brush, at a fragment of a stroke.
// Defines: CARRIED: the stroke is on a model or a mover.
// Inputs:  brushes: R coverage of the brush's paint, G its height; stroke.vert's of the stroke, which
//          is drawn kSmooth px wider on each side than it is (stroke_strips.comp).
// Outputs: 0: sRGB-coded colour, premultiplied, and its coverage; 1: height, premultiplied, and in
//          G the amount of paint. To be blended over the existing paint.
// Precision: mediump suffices, except for places.
uniform sampler2D brushes;
in vec2 brush;
flat in vec4 paint;
flat in float aspect;
flat in float sense;
layout(location = 0) out vec4 colour;
layout(location = 1) out vec4 height;

const float kThinEnd = 1.2;  // widths
const float kVariants = 4.0;
const float kSmooth = 0.75;  // px, as in stroke_strips.comp

// The drawn width by the stroke's.
float drawnWidth() { return abs(sense); }

// Across the stroke, from -1 to 1; beyond that, where it is only drawn.
float acrossStroke() {
  float row = kVariants * brush.y;
  return drawnWidth() * (2.0 * (row - floor(row) - 0.02) / 0.96 - 1.0);
}

// The brush's ends keep their shape: a width of each end takes the texture's first and last
// quarter.
vec2 brushPlace() {
  float cap = min(1.0, 0.5 * aspect);
  float fromStart = brush.x * aspect;
  float fromEnd = aspect - fromStart;
  float onward = fromStart < cap ? 0.25 * fromStart / cap
                 : fromEnd < cap ? 1.0 - 0.25 * fromEnd / cap
                                 : 0.25 + 0.5 * (fromStart - cap) / max(aspect - 2.0 * cap, 1e-3);
  float across = clamp(acrossStroke(), -1.0, 1.0);
  return vec2(onward, (floor(kVariants * brush.y) + 0.5 + 0.48 * across) / kVariants);
}

#ifdef CARRIED
// The brush without its bristles of two texels.
vec2 softAt(vec2 place) {
  vec2 texel = 1.0 / vec2(textureSize(brushes, 0));
  vec2 aside = vec2(0.5, 1.0) * texel;
  // Taps are not to read the next variant.
  float variant = floor(kVariants * brush.y) / kVariants;
  vec2 rows = variant + vec2(0.5 * texel.y, 1.0 / kVariants - 0.5 * texel.y);
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 4; ++i) {
    vec2 tap = place + aside * (2.0 * vec2(i & 1, i >> 1) - 1.0);
    sum += texture(brushes, vec2(tap.x, clamp(tap.y, rows.x, rows.y))).rg;
  }
  return 0.25 * sum;
}
#endif

// Coverage and height. The side of a stroke is smooth: a step would look different with each part
// of a pixel that the stroke moves. So would bristles of two texels, which are a pixel in the
// finest strokes; they go where strokes are carried by models and movers.
vec2 markAt(vec2 place) {
#ifdef CARRIED
  vec2 mark = softAt(place);
#else
  vec2 mark = texture(brushes, place).rg;
#endif
  float halfWidth = kSmooth / (drawnWidth() - 1.0);
  float side = clamp(0.5 + halfWidth * (1.0 - abs(acrossStroke())), 0.0, 1.0);
  return mark * vec2(side, 1.0);
}

// Less pigment on the sides of ridges, more in the shade of furrows: the colour follows the height.
vec3 pigment(float thick) { return paint.rgb * (0.94 + 0.12 * thick); }

// `cover`: of the colour, `body`: of the height.
void leave(vec3 rgb, float thick, float cover, float body) {
  colour = vec4(rgb * cover, cover);
  // At its ends the paint fades into the paint below; a step would be a seam across the stroke.
  float fromEnds = aspect * min(brush.x, 1.0 - brush.x);
  body *= smoothstep(0.0, kThinEnd, fromEnds);
  height = vec4(thick * body, body, 0.0, body);
}
