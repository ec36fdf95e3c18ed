// Purpose: a picture at another size. Each output pixel is the mean of the area it covers when the
//          picture shrinks, and bilinear when it grows.
// Inputs:  picture (LINEAR), sourceOrigin and sourceScale: source px = origin + scale * output px.
// Outputs: RGBA8. Precision: highp for coordinates; colours are averaged as coded, as cameras do.
uniform sampler2D picture;
uniform vec2 sourceOrigin;
uniform vec2 sourceScale;

layout(location = 0) out vec4 colour;

void main() {
  vec2 size = vec2(textureSize(picture, 0));
  vec2 lower = sourceOrigin + sourceScale * (gl_FragCoord.xy - 0.5);
  // Bilinear taps two source pixels apart cover the area; one tap where the picture grows.
  ivec2 taps = max(ivec2(ceil(sourceScale * 0.5)), ivec2(1));
  vec2 apart = sourceScale / vec2(taps);
  vec4 sum = vec4(0.0);
  for (int j = 0; j < taps.y; ++j) {
    for (int i = 0; i < taps.x; ++i) {
      sum += texture(picture, (lower + (vec2(i, j) + 0.5) * apart) / size);
    }
  }
  colour = sum / float(taps.x * taps.y);
}
