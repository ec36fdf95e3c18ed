// Purpose: forgets what is known of models' surfaces behind real things (scene::ModelHiding).
// Inputs:  front: G over 0.5 where a real thing is before the models; size: of the target, px.
// Outputs: where that is, ArFrame's motion RGBA16F (unknown), barycentrics, parts and forms R32UI:
//          all 0. Elsewhere nothing.
// Precision: highp for places.
uniform highp sampler2D front;
uniform vec2 size;

layout(location = 0) out vec4 motion;
layout(location = 1) out uint barycentrics;
layout(location = 2) out uint parts;
layout(location = 3) out uint forms;

void main() {
  if (textureLod(front, gl_FragCoord.xy / size, 0.0).g <= 0.5) discard;
  motion = vec4(0.0);
  barycentrics = 0u;
  parts = 0u;
  forms = 0u;
}
