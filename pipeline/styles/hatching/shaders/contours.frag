// Purpose: contour lines: edges of the image, smoothed along their direction, and the silhouettes,
//          creases and part borders of models; and the outlines of movers, but not where what is
//          beside them, or the remembered background, is seen inside: labels reach beyond what
//          moves, and may end within it. Where fidelity is higher (fidelity.glsl), contours
//          are of finer shades, and movers have no outlines where it is full.
// Defines: MODELS: with the lines of models.
// Inputs:  edges (contour_edges.frag, LINEAR); contour_field.glsl's and mover_labels.glsl's; step_:
//          px between taps; threshold: the least difference that is a line, in luma; sign_: -1 for
//          lines on the dark side of edges, 1 for the light one; picture: the image that tones are
//          taken from (LINEAR); background (marks::MotionLayers); MODELS: ids, normalFocus (ArFrame).
// Outputs: RG8: R ink, in [0, 1]; G the other side of edges, which stays bare where all around is
//          dark (light, in inverted looks).
// Precision: highp.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/marks/shaders/colour_difference.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/styles/hatching/shaders/contour_field.glsl"
#ifdef MODELS
#include "pipeline/scene/render/shaders/object_id.glsl"
uniform highp usampler2D ids;
uniform sampler2D normalFocus;
#endif
uniform sampler2D edges;
uniform float step_;
uniform float threshold;
uniform float sign_;
uniform sampler2D picture;
uniform highp sampler2D background;
layout(location = 0) out vec2 contour;

const float kStride = 1.8;  // steps between taps: specks of a texture are shorter than a line
const float kFaithfulStride = 0.3;  // of that, where fidelity is 1
// From no line to a whole one, in thresholds.
const vec2 kRange = vec2(0.6, 1.4);
const vec2 kFaithfulRange = vec2(0.27, 1.44);
const float kSmooth[4] = float[4](0.24, 0.2, 0.12, 0.06);

// To one of four sides, and its opposite.
vec2 sideOf(int i) {
  float side = float(2 * (i & 1) - 1);
  return i < 2 ? vec2(side, 0.0) : vec2(0.0, side);
}

vec3 seenAt(vec2 px) { return textureLod(picture, px * pixelsOfFull / size, 0.0).rgb; }

// The largest difference of colour, from px to 3 px inside the label, to the remembered background,
// if that was seen there, or half of that to what is beside it, whose shades may differ: the lesser.
// Not asked: 0.
float unlikeGround(vec2 px, bool isAsked) {
  const float kBeside = 3.0;  // px, to find the inner side
  const float kOutside = 5.0;
  const int kTaps = 3;
  const float kTapPx = 1.5;
  vec2 inwards = vec2(0.0);
  for (int i = isAsked ? 0 : 4; i < 4; ++i) {
    inwards += moverAt(px + kBeside * sideOf(i)).r * sideOf(i);
  }
  inwards *= inversesqrt(max(dot(inwards, inwards), 1e-6));
  vec3 beside = seenAt(px - kOutside * inwards);
  vec2 most = vec2(0.0);
  for (int i = isAsked ? 0 : kTaps; i < kTaps; ++i) {
    vec2 at = px + kTapPx * float(i) * inwards;
    vec4 behind = textureLod(background, inLayers(background, at), 0.0);
    vec3 seen = seenAt(at);
    float unlike = behind.a < 1.0 ? 1.0 : apart(seen, behind.rgb);
    most = max(most, vec2(unlike, apart(seen, beside)));
  }
  return min(most.x, 0.5 * most.y);
}

// The outline of labels that are averaged over nine places, so that it has no steps of their cells,
// and none around specks: what is narrower than kSpread may have none. Of loops that no invocation
// enters, software renderers run a single round; of a condition, both sides.
float moverLine(vec2 px) {
  const float kSpread = 2.5;  // px between the places
  const float kRamp = 3.5;    // px: half of what the average takes from 0 to 1
  const float kAll = 3.99;    // filters are coarse
  float mover = 0.0;
  for (int i = 0; i < 4; ++i) {
    mover += moverAt(px + kSpread * (2.0 * vec2(i & 1, i >> 1) - 1.0)).r;
  }
  bool isNear = mover > 0.0 && mover < kAll;
  for (int i = isNear ? 0 : 5; i < 5; ++i) {
    mover += moverAt(px + (i < 4 ? kSpread * sideOf(i) : vec2(0.0))).r;
  }
  float off = abs(2.0 * mover / 9.0 - 1.0) * kRamp * pixelsOfFull.x;
  float line = clamp(min(0.5 * step_ + 0.5, kRamp * pixelsOfFull.x) - off, 0.0, 1.0);
  line *= isNear ? 1.0 : 0.0;
  return line * smoothstep(0.05, 0.1, unlikeGround(px, line > 0.0));
}

// What shows how dim light is: differences fall with it.
float shadeAt(vec2 px) {
  const float kSkin = 0.6;    // luma, well lit
  const float kLeast = 0.3;
  float light = lumaOf(seenAt(px)) / kSkin;
  return clamp(light * light, kLeast, 1.0);
}

float edgeAt(vec2 pixel) { return textureLod(edges, pixel / size, 0.0).r; }

#ifdef MODELS
const float kCrease = 0.8;  // cosine between the normals of neighbouring pixels

uvec2 thingAt(ivec2 p) {
  uint object = objectOf(texelFetch(ids, p, 0).r);
  if (!isVirtual(object)) return uvec2(0u);
  return uvec2(object, labelOf(texelFetch(forms, p, 0).r));
}

vec3 normalAt(ivec2 p) { return normalize(texelFetch(normalFocus, p, 0).xyz * 2.0 - 1.0); }

// Silhouettes, on both sides, by the share of the surroundings that is another object; lighter and
// a pixel wide, borders between patches, and creases.
float modelLines(ivec2 p) {
  const float kPart = 0.7;
  ivec2 last = textureSize(ids, 0) - 1;
  uvec2 own = thingAt(p);
  float other = 0.0;
  float inner = 0.0;
  for (int i = 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3) - 1;
    ivec2 at = clamp(p + step, ivec2(0), last);
    uvec2 thing = thingAt(at);
    float weight = float((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
    if (thing.x != own.x) other += weight;
    if (thing.x != own.x || own.x == 0u || (i != 5 && i != 7)) continue;
    if (thing.y != own.y) {
      inner = kPart;
    } else {
      float turn = dot(normalAt(p), normalAt(at));
      inner = max(inner, kPart * (1.0 - smoothstep(kCrease - 0.3, kCrease, turn)));
    }
  }
  return max(smoothstep(0.05, 0.25, other), inner);
}
#endif

void main() {
  float fidelity = fidelityOf(gl_FragCoord.xy);
  float stride = kStride * mix(1.0, kFaithfulStride, fidelity) * step_;
  vec2 gradient = gradientAt(gl_FragCoord.xy);
  float sum = kSmooth[0] * edgeAt(gl_FragCoord.xy);
  for (int side = -1; side <= 1; side += 2) {
    vec2 at = gl_FragCoord.xy;
    vec2 along = float(side) * vec2(-gradient.y, gradient.x);
    for (int i = 1; i < 4; ++i) {
      at += stride * along;
      sum += kSmooth[i] * edgeAt(at);
    }
  }
  vec2 range = threshold * mix(kRange, kFaithfulRange * shadeAt(gl_FragCoord.xy / pixelsOfFull), fidelity);
  contour = smoothstep(vec2(range.x), vec2(range.y), vec2(sign_, -sign_) * sum);
  // Labels have gaps within faces, which are not outlined.
  float outlined = 1.0 - smoothstep(0.8, 0.95, fidelity);
  contour.r = max(contour.r, outlined * moverLine(gl_FragCoord.xy / pixelsOfFull));
#ifdef MODELS
  ivec2 p = ivec2(gl_FragCoord.xy);
  contour.r = max(contour.r, modelLines(p));
#endif
}
