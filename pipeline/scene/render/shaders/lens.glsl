// Purpose: lens distortion: Brown-Conrady with OpenCV's rational terms, as in
//          tracking/camera/camera_model.h.
// Inputs:  its coefficients, and the radius up to which they hold (scene::setLens()).
// Outputs: the shift of a point by the lens.
// Precision: highp; a hundredth of a pixel at 1280 px needs 17 bits.
uniform vec3 radial;      // k1 k2 k3
uniform vec2 tangential;  // p1 p2
uniform vec3 radialBelow; // k4 k5 k6
uniform float trustedRadius;

// Shift of a point on the plane z = 1 by the lens. Beyond the trusted radius: the shift at that
// radius.
vec2 lensShift(vec2 p) {
  p *= min(1.0, trustedRadius / max(length(p), 1e-9));
  float r2 = dot(p, p);
  float above = 1.0 + r2 * (radial.x + r2 * (radial.y + r2 * radial.z));
  float below = 1.0 + r2 * (radialBelow.x + r2 * (radialBelow.y + r2 * radialBelow.z));
  vec2 bent = vec2(2.0 * tangential.x * p.x * p.y + tangential.y * (r2 + 2.0 * p.x * p.x),
                   tangential.x * (r2 + 2.0 * p.y * p.y) + 2.0 * tangential.y * p.x * p.y);
  return p * (above / below - 1.0) + bent;
}

// A camera point shifted by the lens, times its depth. The shift is bounded, so that it fades to
// zero towards z = 0, and is zero behind the camera.
vec3 throughLens(vec3 p) {
  if (p.z > 0.0) p.xy += p.z * lensShift(p.xy / p.z);
  return p;
}
