// Purpose: the shape of a real object, which hides models behind it: the unchanged camera image with the
//          object's id and, by the depth test, its depth.
// Inputs:  picture, of the target's size; triangle; object.
// Outputs: colour RGBA8; ids R32UI; normalFocus RGBA8: no normal, focus 0.
// Precision: exact, a copy.
#include "pipeline/scene/render/shaders/object_id.glsl"

uniform sampler2D picture;
uniform uint object;

flat in uint triangle;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

void main() {
  colour = vec4(texelFetch(picture, ivec2(gl_FragCoord.xy), 0).rgb, 1.0);
  ids = idOf(object, triangle);
  normalFocus = vec4(vec3(128.0 / 255.0), 0.0);
}
