// Purpose: the segments of the camera image (tracking::ImageSegments): which one a pixel is of. The
//          grid is coarse; at a border, the pixel's colour decides.
// Inputs:  segmentCells (marks::SegmentMap): from the lowest bit, 12 bits of a label, 1 bit: all
//          cells around are the same segment's; 7, 6 and 6 bits of its luma and chroma there;
//          segmentGrid: cell = px * xy + zw; hasSegments: else nothing is read. Places in px of the
//          full image, colours sRGB-coded.
// Outputs: labels as in stroke_label.glsl.
// Precision: highp.
#include "pipeline/marks/shaders/stroke_label.glsl"
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

// The segment of a square, or 0 if it has several.
uint segmentOfSquare(vec2 middle, float side) {
  if (!hasSegments) return 0u;
  uint first = coarseSegmentAt(middle - 0.25 * side);
  uint same = first;
  for (int i = 1; i < 4; ++i) {
    vec2 corner = 2.0 * vec2(i & 1, i >> 1) - 1.0;
    if (coarseSegmentAt(middle + 0.25 * side * corner) != first) same = 0u;
  }
  return same;
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

SegmentBorder segmentBorderAt(vec2 px, vec3 seen) {
  if (!hasSegments) return SegmentBorder(0u, 0u, 1.0);
  const float kAway = 0.05;  // of colour, for each cell of distance
  vec2 at = px * segmentGrid.xy + segmentGrid.zw;
  ivec2 middle = ivec2(floor(at));
  uint here = cellAt(middle);
  uint label = segmentOf(here);
  SegmentBorder border = SegmentBorder(label, label, 1.0);
  vec3 own = lumaAndChroma(seen);
  vec3 first = own;
  vec3 second = own;
  float least = 1e6;
  float next = 1e6;
  // A loop that no invocation enters costs nothing on software renderers.
  bool isInside = (here >> 12u & 1u) != 0u;
  for (int i = isInside ? 9 : 0; i < 9; ++i) {
    ivec2 there = middle + ivec2(i % 3, i / 3) - 1;
    uint cell = cellAt(there);
    uint segment = segmentOf(cell);
    vec3 colour = colourOfCell(cell);
    vec3 difference = colour - own;
    float away = sqrt(dot(difference * difference, kPerceived)) +
                 kAway * distance(at, vec2(there) + 0.5);
    if (away < least) {
      if (segment != border.own || least > 1e5) {
        border.other = least > 1e5 ? segment : border.own;
        next = least;
        second = first;
      }
      border.own = segment;
      least = away;
      first = colour;
    } else if (segment != border.own && away < next) {
      border.other = segment;
      next = away;
      second = colour;
    }
  }
  if (border.own == 0u || border.other == 0u) border.other = border.own;
  if (border.other == border.own) return border;
  vec3 between = first - second;
  border.share = clamp(dot(own - second, kPerceived * between) /
                           max(dot(between, kPerceived * between), 1e-6), 0.0, 1.0);
  return border;
}
