// Purpose: how much of a place moves over the paper, before a camera that stands: what the paper does
//          to paint would glide over it.
// Inputs:  motion (marks::MotionField::backward()); before: the previous frame's; perSecond: frames a
//          second, 0 while the camera moves, since the paper goes with it; kept: what is left of the
//          previous frame's; fullByReference: px of the full image to one of 640x480.
// Outputs: RGBA8: in all channels 0, nothing, to 1. One texel for each of `motion`.
// Precision: highp for motion.
uniform highp sampler2D motion;
uniform sampler2D before;
uniform float perSecond;
uniform float kept;
uniform float fullByReference;
layout(location = 0) out vec4 gliding;

const vec2 kSpeed = vec2(12.0, 36.0);  // px a second, of a picture of 640x480

void main() {
  highp vec4 moved = texelFetch(motion, ivec2(gl_FragCoord.xy), 0);
  highp float px = moved.w > 0.5 ? max(length(moved.xy) - moved.z, 0.0) : 0.0;
  float now = smoothstep(kSpeed.x, kSpeed.y, px * perSecond / fullByReference);
  gliding = vec4(max(now, kept * texelFetch(before, ivec2(gl_FragCoord.xy), 0).r));
}
