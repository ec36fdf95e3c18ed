// Purpose: which look (overlay::PartLook) the part has that each pixel shows.
// Inputs:  ids of the AR frame, of any size; outputSize; object: of the machine in them; looks: of
//          its triangles, 1024 a row.
// Outputs: R8: the look's number / 255; 0 beside the machine. Precision: integers.
#include "pipeline/scene/render/shaders/object_id.glsl"

uniform highp usampler2D ids;
uniform vec2 outputSize;
uniform uint object;
uniform sampler2D looks;

layout(location = 0) out vec4 look;

const uint kLookColumns = 1024u;

void main() {
  ivec2 idSize = textureSize(ids, 0);
  ivec2 place = min(ivec2(gl_FragCoord.xy * vec2(idSize) / outputSize), idSize - 1);
  uint id = texelFetch(ids, place, 0).r;
  if (objectOf(id) != object) {
    look = vec4(0.0);
    return;
  }
  uint number = numberOf(id);
  ivec2 texel = ivec2(int(number % kLookColumns), int(number / kLookColumns));
  look = vec4(texelFetch(looks, texel, 0).r, 0.0, 0.0, 1.0);
}
