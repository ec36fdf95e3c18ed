// Purpose: a picture over the output, pixel for pixel.
// Inputs:  picture (alpha premultiplied), its origin in the output (whole px), opacity.
// Outputs: RGBA8, alpha premultiplied. Precision: exact, a copy.
uniform sampler2D picture;
uniform vec2 origin;
uniform float opacity;

layout(location = 0) out vec4 colour;

void main() {
  ivec2 last = textureSize(picture, 0) - 1;
  colour = opacity * texelFetch(picture, clamp(ivec2(gl_FragCoord.xy - origin), ivec2(0), last), 0);
}
