// Purpose: a picture over the output: pixel for pixel, or scaled where its rectangle has another size.
// Inputs:  picture (alpha premultiplied), its rectangle in the output (origin and size, whole px), opacity.
// Outputs: RGBA8, alpha premultiplied. Precision: exact at its own size: samples at texel centres.
uniform sampler2D picture;
uniform vec2 origin;
uniform vec2 size;
uniform float opacity;

layout(location = 0) out vec4 colour;

void main() {
  colour = opacity * texture(picture, (gl_FragCoord.xy - origin) / size);
}
