// Purpose: a camera's RGB or RGBA picture becomes an opaque one.
// Inputs:  plane0 (RGB8 or RGBA8; R8, three times as wide).
// Outputs: RGBA8, alpha 1. Precision: colours pass through.
// Defines: BYTES: plane0 has a byte a texel, because drivers import no layout of three bytes.
uniform sampler2D plane0;

layout(location = 0) out vec4 colour;

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
#ifdef BYTES
  ivec2 at = ivec2(3 * p.x, p.y);
  colour = vec4(texelFetch(plane0, at, 0).r, texelFetch(plane0, at + ivec2(1, 0), 0).r,
                texelFetch(plane0, at + ivec2(2, 0), 0).r, 1.0);
#else
  colour = vec4(texelFetch(plane0, p, 0).rgb, 1.0);
#endif
}
