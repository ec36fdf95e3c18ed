// Purpose: unit vectors in 32 bits (Cigolle et al., "A Survey of Efficient Representations for
//          Independent Unit Vectors", 2014), as scene::octahedral() packs them.
// Inputs:  unit vectors, or two 16-bit snorms in a word.
// Outputs: the respective other form.
// Precision: highp; 16 bits per coordinate, 0.003 degrees.
vec2 octahedralFold(vec2 flat2) {
  return (1.0 - abs(flat2.yx)) *
         vec2(flat2.x < 0.0 ? -1.0 : 1.0, flat2.y < 0.0 ? -1.0 : 1.0);
}

vec3 fromOctahedral(uint bits) {
  vec2 f = unpackSnorm2x16(bits);
  vec3 v = vec3(f, 1.0 - abs(f.x) - abs(f.y));
  if (v.z < 0.0) v.xy = octahedralFold(v.xy);
  return normalize(v);
}

uint toOctahedral(vec3 unit) {
  vec3 v = unit / (abs(unit.x) + abs(unit.y) + abs(unit.z));
  if (v.z < 0.0) v.xy = octahedralFold(v.xy);
  return packSnorm2x16(v.xy);
}
