// Purpose: an image at half its size: the mean of 2x2 pixels.
// Inputs:  picture (LINEAR); size: of the output.
// Outputs: the same format.
// Precision: highp for places.
uniform sampler2D picture;
uniform vec2 size;
layout(location = 0) out vec4 half_;

void main() { half_ = texture(picture, gl_FragCoord.xy / size); }
