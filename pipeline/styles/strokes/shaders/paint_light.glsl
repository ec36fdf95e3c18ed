// Purpose: the light on the paint, from the upper left.
// Inputs:  the surface's normal.
// Outputs: the factors below.
// Precision: mediump suffices.
const vec3 kLight = vec3(-0.5145, -0.6860, 0.5145);

// Diffuse light; 1 on flat paint.
float litBy(vec3 normal) { return dot(normal, kLight) / kLight.z; }

// Specular light; 0 on flat paint.
float shineOf(vec3 normal) {
  vec3 halfway = normalize(kLight + vec3(0.0, 0.0, 1.0));
  return max(pow(max(dot(normal, halfway), 0.0), 40.0) - pow(halfway.z, 40.0), 0.0);
}

vec3 inLight(vec3 rgb, float lit) { return rgb * (1.0 + 0.6 * (clamp(lit, 0.3, 1.8) - 1.0)); }
