// Purpose: the painting at the output's size, on which the overlay is drawn.
// Inputs:  painted (LINEAR), of any size; outputSize.
// Outputs: RGBA8. Precision: highp for the place, a copy otherwise.
uniform sampler2D painted;
uniform vec2 outputSize;

layout(location = 0) out vec4 colour;

void main() { colour = vec4(texture(painted, gl_FragCoord.xy / outputSize).rgb, 1.0); }
