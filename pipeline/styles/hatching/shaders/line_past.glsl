// Purpose: how much of a line's past stays in this frame, by what it lies on.
// Inputs:  past: the share on models, of the background, and on movers, whose shapes change with
//          every step.
// Outputs: a share in [0, 1].
// Precision: highp.
#include "pipeline/scene/render/shaders/surface_form.glsl"
uniform vec3 past;

float pastOn(uint support) {
  return support == 0u ? past.y : support == kMoverLabel ? past.z : past.x;
}
