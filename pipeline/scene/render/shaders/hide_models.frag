// Purpose: hides models, and their shadows, behind real things (scene::ModelHiding).
// Inputs:  camera: the camera image, of the target's size; front: G over 0.5 where a real thing is
//          before the models; size: of the target, px.
// Outputs: where that is: colour RGBA8, the camera's; ids R32UI: 0; normalFocus RGBA8: no normal,
//          focus 0. Elsewhere nothing.
// Precision: exact, a copy; highp for places.
uniform sampler2D camera;
uniform highp sampler2D front;
uniform vec2 size;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

void main() {
  if (textureLod(front, gl_FragCoord.xy / size, 0.0).g <= 0.5) discard;
  colour = vec4(texelFetch(camera, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
  ids = 0u;
  normalFocus = vec4(vec3(128.0 / 255.0), 0.0);
}
