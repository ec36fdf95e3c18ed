// Purpose: whether a surface ends and another begins behind it.
// Inputs:  depthRange: the near and the far plane, metres; window depths.
// Outputs: metres; a verdict.
// Precision: highp.
uniform vec2 depthRange;

// Window depth is linear on a plane in the image: where it is not, by so much, another surface
// begins. In metres per metre of distance.
const float kDepthStep = 0.02;

float metresOf(float window) {
  float near = depthRange.x;
  float far = depthRange.y;
  return near * far / (far - window * (far - near));
}

// Whether a window depth differs from the expected one, `apart`, by a step. `window`: about there.
bool isDepthStep(float apart, float window) {
  float near = depthRange.x;
  float far = depthRange.y;
  float metres = metresOf(window);
  float perWindow = metres * metres * (far - near) / (near * far);
  return abs(apart) * perWindow > kDepthStep * metres;
}
