// Purpose: whether a stroke may come to models.
// Inputs:  px: where it begins; segment: the length of a step, px of the full image; bounds: of
//          models (ArFrame::objectBounds), in pixels, of which `pixels` go to a px.
// Outputs: functions. Precision: highp.
#include "pipeline/marks/strokes/shaders/stroke.glsl"

bool reachesObjects(vec2 px, float segment, vec4 bounds, vec2 pixels) {
  vec2 reach = (segment * float(kArm) + 2.0) * pixels;
  vec2 at = px * pixels;
  return all(greaterThanEqual(at, bounds.xy - reach)) && all(lessThanEqual(at, bounds.zw + reach));
}
