// Purpose: the light that falls on paint, from the upper left.
// Inputs:  the surface's normal. Outputs: see below. Precision: mediump would do.
const vec3 kLight = vec3(-0.5145, -0.6860, 0.5145);

// 1 where the paint lies flat.
float litBy(vec3 normal) { return dot(normal, kLight) / kLight.z; }

// What gloss adds; nothing where the paint lies flat.
float shineOf(vec3 normal) {
  vec3 halfway = normalize(kLight + vec3(0.0, 0.0, 1.0));
  return max(pow(max(dot(normal, halfway), 0.0), 40.0) - pow(halfway.z, 40.0), 0.0);
}

vec3 inLight(vec3 rgb, float lit) { return rgb * (1.0 + 0.6 * (clamp(lit, 0.3, 1.8) - 1.0)); }
