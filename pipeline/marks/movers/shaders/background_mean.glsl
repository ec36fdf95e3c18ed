// Purpose: the running mean of the background's colours.
// Inputs:  colours; the frames in the mean so far.
// Outputs: the mean, and in A the frames in it.
// Precision: highp.
const float kFrames = 30.0;
const float kMovingFrames = 4.0;  // while the camera moves: each frame's interpolation blurs

float framesWith(float known, float most) { return min(floor(known + 0.5) + 1.0, most); }

vec4 withColour(vec4 known, vec3 now, float frames) {
  return vec4(mix(known.rgb, now, 1.0 / frames), frames);
}
