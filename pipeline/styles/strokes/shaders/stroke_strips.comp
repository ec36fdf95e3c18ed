// Purpose: the vertices of strokes: each stroke is a strip of quads along its spline, and all
//          strips are joined into one.
// Defines: LONG: stroke_strip.glsl's. Vertices then have half of the width at their place and the
//          length, px, as the shape, and in `brush` the part across the stroke; `label` has the
//          variant in its upper half.
// Inputs:  instances, instanceCount of them in drawn; plans (stroke_offsets.comp); even: if above
//          0, the number of quads of every strip (the thesis's 4 (n + 2), §4.4).
// Outputs: vertices in the layout of stroke.vert, the sides kSmooth px further out, for smooth
//          edges. One invocation per stroke.
// Precision: highp.
#include "pipeline/marks/strokes/shaders/stroke_label.glsl"
#include "pipeline/styles/strokes/shaders/strip_spline.glsl"
layout(local_size_x = 64) in;
struct Vertex {
  vec2 at;
  uint brush;   // unorms: along and across the stroke, in the brush's variant
  uint along;   // snorms: the stroke's direction
  uvec2 paint;  // halves
  uint shape;  // halves: the stroke's length by its width; the sense of the brush across it, times
               // the drawn width by the stroke's
  uint label;
};
layout(std430, binding = 1) readonly buffer Drawn { DrawCommand drawn; };
layout(std430, binding = 2) readonly buffer Plans { StripPlan plans[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 3) volatile writeonly buffer Vertices { Vertex vertices[]; };
uniform uint even;

const float kVariants = 4.0;
const float kSmooth = 0.75;  // px
const float kBeyond = 0.6;  // half widths: the brush's own round ends go beyond the skeleton's

void main() {
  uint rank = gl_GlobalInvocationID.x;
  if (rank >= drawn.instanceCount) return;
  vec4 paint = instances[rank].paint;
  vec4 shape = instances[rank].shape;
  StripPlan plan = plans[rank];
#ifdef LONG
  float reach = 0.0;
#else
  float reach = kBeyond * shape.x;
#endif
  float way = splineLength(rank);
  float whole = max(way + 2.0 * reach, 1e-3);
  uint variant = uint(shape.y) & 3u;
  float sense = shape.y >= kVariants ? -1.0 : 1.0;
#ifndef LONG
  float broader = 1.0 + kSmooth / max(shape.x, 0.5);
#endif
  Vertex made;
  made.paint = uvec2(packHalf2x16(paint.rg), packHalf2x16(paint.ba));
  float aspect = min(0.5 * whole / max(shape.x, 0.5), 1000.0);
#ifdef LONG
  made.shape = packHalf2x16(vec2(aspect, sense));
  made.label = uint(shape.z) | variant << 16u;
#else
  made.shape = packHalf2x16(vec2(aspect, sense * broader));
  made.label = uint(shape.z);
#endif
  uint next = plan.first;
  uint breaks = breaksOf(plan);
  uint quads = even > 0u ? even : 1u + uint(bitCount(breaks));
  for (uint i = 0u; i <= quads; ++i) {
    float s = float(kSplineSpans);
    if (i == 0u) {
      s = 0.0;
    } else if (even > 0u) {
      s = float(kSplineSpans) * float(i) / float(even);
    } else if (i < quads) {
      s = float(findLSB(breaks));
      breaks &= breaks - 1u;
    }
    SplinePlace place = splineAt(rank, s);
    float beyond = i == 0u ? -1.0 : (i == quads ? 1.0 : 0.0);
    float part = (place.part * way + (1.0 + beyond) * reach) / whole;
    made.along = packSnorm2x16(place.along);
#ifdef LONG
    float halfWidth = halfWidthAt(rank, place.part);
    made.shape = packHalf2x16(vec2(halfWidth, way));
#endif
    for (int side = -1; side <= 1; side += 2) {
      float across = float(side);
#ifdef LONG
      made.at = place.at + across * (halfWidth + kSmooth) * vec2(-place.along.y, place.along.x);
      made.brush = packUnorm2x16(vec2(part, 0.5 + 0.5 * across));
#else
      made.at = place.at + beyond * reach * place.along +
                across * shape.x * broader * vec2(-place.along.y, place.along.x);
      float row = float(variant) + 0.02 + 0.96 * (0.5 + 0.5 * sense * across);
      made.brush = packUnorm2x16(vec2(part, row / kVariants));
#endif
      vertices[next] = made;
      ++next;
      if ((i == 0u && side < 0) || (i == quads && side > 0)) {
        vertices[next] = made;
        ++next;
      }
    }
  }
}
