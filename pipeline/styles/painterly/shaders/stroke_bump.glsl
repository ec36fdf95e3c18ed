// Purpose: light on each stroke by itself, as the thesis has it (§4.4): the normal from the finite
//          differences of the brush's height, in the stroke's tangent frame.
// Inputs:  relief, gloss: how much; stroke_mark.glsl's; along: the stroke's direction; sense: of the
//          brush across it. Outputs: the paint, lit. Precision: mediump would do.
uniform float relief;
uniform float gloss;
in vec2 along;
flat in float sense;

vec3 bumped(vec3 rgb, vec2 place) {
  float left = textureOffset(brushes, place, ivec2(-1, 0)).g;
  float right = textureOffset(brushes, place, ivec2(1, 0)).g;
  float bottom = textureOffset(brushes, place, ivec2(0, -1)).g;
  float top = textureOffset(brushes, place, ivec2(0, 1)).g;
  vec2 onward = normalize(along);
  vec2 across = sense * vec2(-onward.y, onward.x);
  vec2 tilt = relief * ((left - right) * onward + (bottom - top) * across);
  vec3 normal = normalize(vec3(tilt, 1.0));
  // relief.frag's light.
  const vec3 kLight = vec3(-0.5145, -0.6860, 0.5145);
  float lit = dot(normal, kLight) / kLight.z;
  vec3 halfway = normalize(kLight + vec3(0.0, 0.0, 1.0));
  float shine = pow(max(dot(normal, halfway), 0.0), 40.0) - pow(halfway.z, 40.0);
  return clamp(rgb * (1.0 + 0.6 * (clamp(lit, 0.3, 1.8) - 1.0)) + gloss * max(shine, 0.0), 0.0, 1.0);
}
