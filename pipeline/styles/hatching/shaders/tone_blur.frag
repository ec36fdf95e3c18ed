// Purpose: the tone that lines render: a smoother image of half the size, the mean of 4x4 pixels
//          under a tent, lightened where the picture is dark.
// Inputs:  halfTone (tone.frag, LINEAR); size: of the output; ToneLightening
//          (tone_lightening.comp); lighten: how much of it, in [0, 1].
// Outputs: the same format.
// Precision: highp for places.
layout(std140, binding = 0) uniform ToneLightening { float lightening; };
uniform sampler2D halfTone;
uniform vec2 size;
uniform float lighten;
layout(location = 0) out vec4 tone;

vec2 lightened(vec2 seen) {
  float luma = seen.x / max(seen.y, 1e-5);
  float k = lighten * lightening;
  return vec2(seen.x * (1.0 + k) / (1.0 + k * luma), seen.y);
}

void main() {
  vec2 place = gl_FragCoord.xy / size;
  vec2 arm = 0.5 / size;
  vec4 mean = 0.25 * (texture(halfTone, place - arm) + texture(halfTone, place + arm) +
                      texture(halfTone, place + vec2(arm.x, -arm.y)) +
                      texture(halfTone, place + vec2(-arm.x, arm.y)));
  tone = vec4(lightened(mean.xy), lightened(mean.zw));
}
