// Purpose: the segments of the camera image (tracking::ImageSegments): which one a pixel is of. The
//          grid is coarse; at a border, the pixel's colour decides.
// Inputs:  segmentCells (marks::SegmentMap): from the lowest bit, 12 bits of a label, 1 bit: all
//          cells around are the same segment's; 7, 6 and 6 bits of its luma and chroma there;
//          segmentGrid: cell = px * xy + zw; hasSegments: else nothing is read. Places in px of the
//          full image, colours sRGB-coded.
// Outputs: labels as in stroke_label.glsl.
// Precision: highp.
#include "pipeline/marks/strokes/shaders/stroke_label.glsl"
uniform highp usampler2D segmentCells;
uniform vec4 segmentGrid;
uniform bool hasSegments;

uint segmentOf(uint cell) {
  uint label = cell & 4095u;
  return label == 0u ? 0u : label | kSegmentLabel;
}

uint cellAt(ivec2 cell) {
  return texelFetch(segmentCells, clamp(cell, ivec2(0), textureSize(segmentCells, 0) - 1), 0).r;
}

// The segment that most of the cell at a place is of.
uint coarseSegmentAt(vec2 px) {
  if (!hasSegments) return 0u;
  return segmentOf(cellAt(ivec2(floor(px * segmentGrid.xy + segmentGrid.zw))));
}

vec3 lumaAndChroma(vec3 colour) {
  float luma = dot(colour, vec3(0.299, 0.587, 0.114));
  return vec3(luma, 0.564 * (colour.b - luma), 0.713 * (colour.r - luma));
}
vec3 colourOfCell(uint cell) {
  return vec3(float(cell >> 13u & 127u) / 127.0, float(cell >> 20u & 63u) / 63.75 - 0.5,
              float(cell >> 26u) / 63.75 - 0.5);
}

const vec3 kPerceived = vec3(3.0, 2.2, 2.3);  // of luma and chroma: colour_difference.glsl's weights

// A pixel's segment, the nearest other one, and the share of the pixel that is its own.
struct SegmentBorder {
  uint own;
  uint other;
  float share;
};

// The colour around a pixel: noise and fine texture move no border.
vec3 colourAround(highp sampler2D picture, vec2 at) {
  vec2 reach = 0.75 / vec2(textureSize(picture, 0));
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    sum += textureLod(picture, at + reach * (2.0 * vec2(i & 1, i >> 1) - 1.0), 0.0).rgb;
  }
  return 0.25 * sum;
}

float awayFrom(vec3 colour, vec3 other) {
  vec3 difference = colour - other;
  return sqrt(dot(difference * difference, kPerceived));
}

// `picture`: the frame's; `place`: px in its texture coordinates. The two segments are those whose
// colours around are the nearest to the pixel's; where it lies between these colours is its share.
// The colours are means over cells, weighted so that a shift of the grid changes little.
SegmentBorder segmentBorderAt(vec2 px, highp sampler2D picture, vec2 place) {
  if (!hasSegments) return SegmentBorder(0u, 0u, 1.0);
  const int kCells = 25;
  const int kAcross = 5;
  const float kWidth = 0.35;  // of the weights: exp(-0.35 d²), d in cells
  vec2 at = px * segmentGrid.xy + segmentGrid.zw;
  ivec2 middle = ivec2(floor(at));
  uint here = cellAt(middle);
  uint label = segmentOf(here);
  SegmentBorder border = SegmentBorder(label, label, 1.0);
  // Where no invocation enters it, software renderers run one round of this loop and of those inside.
  bool isInside = (here >> 12u & 1u) != 0u;
  for (int once = isInside ? 1 : 0; once < 1; ++once) {
    vec3 own = lumaAndChroma(colourAround(picture, place));
    // Up to three segments: that of the pixel's cell, and the next ones.
    uvec3 labels = uvec3(label, label, label);
    vec4 first = vec4(0.0);
    vec4 second = vec4(0.0);
    vec4 third = vec4(0.0);
    for (int i = 0; i < kCells; ++i) {
      ivec2 there = middle + ivec2(i % kAcross, i / kAcross) - kAcross / 2;
      uint cell = cellAt(there);
      uint segment = segmentOf(cell);
      vec2 arm = at - (vec2(there) + 0.5);
      vec4 weighted = exp(-kWidth * dot(arm, arm)) * vec4(colourOfCell(cell), 1.0);
      if (segment == labels.x) {
        first += weighted;
      } else if (segment == labels.y || labels.y == labels.x) {
        labels.y = segment;
        second += weighted;
      } else if (segment == labels.z || labels.z == labels.x) {
        labels.z = segment;
        third += weighted;
      }
    }
    const float kNegligible = 0.02;  // weight: too far away
    vec3 aways = vec3(awayFrom(first.rgb / first.a, own), 1e3, 1e3);
    if (second.a > kNegligible) aways.y = awayFrom(second.rgb / second.a, own);
    if (third.a > kNegligible) aways.z = awayFrom(third.rgb / third.a, own);
    if (aways.z < min(aways.x, aways.y) || (aways.z < aways.y && aways.y < 1e3)) {
      // The third one is among the nearest two.
      labels.yz = labels.zy;
      aways.yz = aways.zy;
      vec4 swapped = second;
      second = third;
      third = swapped;
    }
    if (aways.z < aways.x) {
      labels.xz = labels.zx;
      aways.xz = aways.zx;
      first = third;
    }
    if (aways.y > 100.0) continue;
    bool isSecond = aways.y < aways.x;
    border.own = isSecond ? labels.y : labels.x;
    border.other = isSecond ? labels.x : labels.y;
    if (border.own == 0u || border.other == 0u) border.other = border.own;
    if (border.other == border.own) continue;
    vec4 one = isSecond ? second : first;
    vec4 two = isSecond ? first : second;
    vec3 between = one.rgb / one.a - two.rgb / two.a;
    float contrast = dot(between, kPerceived * between);
    float part = dot(own - two.rgb / two.a, kPerceived * between) / max(contrast, 1e-6);
    // Where the colours are alike, the cells decide.
    part = mix(one.a / (one.a + two.a), part, smoothstep(0.06, 0.16, sqrt(contrast)));
    border.share = smoothstep(0.2, 0.8, part);
    if (border.share < 0.5) {
      border.share = 1.0 - border.share;
      border.own = isSecond ? labels.x : labels.y;
      border.other = isSecond ? labels.y : labels.x;
    }
  }
  return border;
}
