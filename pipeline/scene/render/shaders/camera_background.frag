// Purpose: the camera image as the background of the models.
// Inputs:  picture, of the target's size.
// Outputs: colour RGBA8; ids R32UI: 0, the camera; normalFocus RGBA8: no normal, focus 0.
// Precision: exact, a copy.
uniform sampler2D picture;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

void main() {
  colour = vec4(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
  ids = 0u;
  normalFocus = vec4(vec3(128.0 / 255.0), 0.0);
}
