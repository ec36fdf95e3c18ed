// Purpose: the averaged past in another size: another level of quality.
// Inputs:  past (steady_picture.comp, LINEAR).
// Outputs: the same in the target's size.
// Precision: highp for places.
uniform sampler2D past;
layout(location = 0) out vec4 resized;

void main() {
  ivec2 size = textureSize(past, 0);
  vec2 at = gl_FragCoord.xy / vec2(float(size.x), float(size.y));
  resized = texture(past, at);
}
