// Purpose: the image's motion as a coarse field, for what carries whole pictures along.
// Inputs:  image_motion.glsl's, flow backward; fieldPixels: the side of a texel in px of the full
//          picture.
// Outputs: field RGBA16F: displacement since the frame before (px of the full picture, to here),
//          predicted error (px), source (anchor.glsl). A texel an invocation.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/marks/shaders/image_motion.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D field;
uniform float fieldPixels;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(field)))) return;
  Moved moved = imageMotionAt((vec2(texel) + 0.5) * fieldPixels, 0.0, true);
  // What is not known is nowhere near half a float's end.
  imageStore(field, texel, vec4(-moved.displacement, min(moved.error, 1.0e4), float(moved.source)));
}
