// Purpose: the image's motion as a coarse field, for passes that warp whole images.
// Inputs:  image_motion.glsl's, flow backward; fieldPixels: the side of a texel in px of the full
//          image.
// Outputs: field RGBA16F: displacement since the previous frame (px of the full image, to here),
//          predicted error (px), source (anchor.glsl). One invocation per texel.
// Precision: highp; the displacement is rounded to 11 bits.
#include "pipeline/marks/shaders/image_motion.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D field;
uniform float fieldPixels;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(field)))) return;
  Moved moved = imageMotionAt((vec2(texel) + 0.5) * fieldPixels, 0.0, true);
  // The error of an unknown motion stays far below the largest half float.
  imageStore(field, texel, vec4(-moved.displacement, min(moved.error, 1.0e4), float(moved.source & kSourceBits)));
}
