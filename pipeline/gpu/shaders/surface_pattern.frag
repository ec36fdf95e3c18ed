// Purpose: the pattern by which it is tried whether what is drawn into an output's surface arrives
//          in its memory (hal::surfacePatternAt()).
// Inputs:  surface, its number.
// Outputs: RGBA8. Precision: highp: whole numbers up to 255 keep their value.
uniform int surface;

layout(location = 0) out vec4 colour;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  int rest = (p.x >> 8) * 16 + (p.y >> 8) + 37 * surface;
  colour = vec4(vec3(ivec3(p, rest) & 255), 255.0) / 255.0;
}
