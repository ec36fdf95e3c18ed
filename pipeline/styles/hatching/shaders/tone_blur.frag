// Purpose: a smoother image of half the size: the mean of 4x4 pixels under a tent.
// Inputs:  picture (LINEAR); size: of the output.
// Outputs: the same format.
// Precision: highp for places.
uniform sampler2D picture;
uniform vec2 size;
layout(location = 0) out vec4 blurred;

void main() {
  vec2 place = gl_FragCoord.xy / size;
  vec2 step = 0.5 / size;
  blurred = 0.25 * (texture(picture, place - step) + texture(picture, place + step) +
                    texture(picture, place + vec2(step.x, -step.y)) +
                    texture(picture, place + vec2(-step.x, step.y)));
}
