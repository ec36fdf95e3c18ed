// Purpose: light on the paint's relief, once a pixel (GPU.md), on its canvas; and what is in focus kept
//          crisp.
// Inputs:  colours, heights (stroke.frag); sheet.glsl-like canvas: weave; frame, normalFocus if hasFocus;
//          relief, gloss, weave: how much of each; palette: saturation, warmth.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp for places.
uniform sampler2D colours;
uniform sampler2D heights;
uniform sampler2D frame;
uniform sampler2D normalFocus;
uniform bool hasFocus;
uniform float relief;
uniform float gloss;
uniform float weave;
uniform vec2 canvasLinear;  // canvas px under the picture's, complex
uniform vec2 canvasShift;
uniform float saturation;
uniform float warmth;
layout(location = 0) out vec4 picture;

// Threads over and under each other, 4 px wide.
float canvasAt(vec2 pixel) {
  vec2 at = vec2(canvasLinear.x * pixel.x - canvasLinear.y * pixel.y,
                 canvasLinear.x * pixel.y + canvasLinear.y * pixel.x) + canvasShift;
  vec2 thread = at * (3.14159265 / 4.0);
  float over = sin(thread.x) * sin(thread.y);
  vec2 ridge = abs(cos(0.5 * thread));
  return over > 0.0 ? ridge.x : ridge.y;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec3 rgb = texelFetch(colours, p, 0).rgb;
  // Each tap is the mean of four: the height of a stroke's side is a step, and would sparkle.
  vec2 texel = 1.0 / vec2(textureSize(heights, 0));
  vec2 place = gl_FragCoord.xy * texel;
  float nw = texture(heights, place + vec2(-0.7, -0.7) * texel).r;
  float ne = texture(heights, place + vec2(0.7, -0.7) * texel).r;
  float sw = texture(heights, place + vec2(-0.7, 0.7) * texel).r;
  float se = texture(heights, place + vec2(0.7, 0.7) * texel).r;
  float here = 0.25 * (nw + ne + sw + se);
  vec2 slope = 0.5 * vec2(ne + se - nw - sw, sw + se - nw - ne) * relief;
  if (weave > 0.0) {
    vec2 at = gl_FragCoord.xy;
    float thread = canvasAt(at);
    slope += weave * (1.0 - 0.7 * here) * vec2(canvasAt(at + vec2(1.0, 0.0)) - thread,
                                              canvasAt(at + vec2(0.0, 1.0)) - thread);
  }
  vec3 normal = normalize(vec3(-slope, 1.0));
  const vec3 kLight = vec3(-0.5145, -0.6860, 0.5145);  // from the upper left
  float lit = dot(normal, kLight) / kLight.z;
  vec3 halfway = normalize(kLight + vec3(0.0, 0.0, 1.0));
  float shine = pow(max(dot(normal, halfway), 0.0), 40.0) - pow(halfway.z, 40.0);
  float luma = dot(rgb, vec3(0.299, 0.587, 0.114));
  rgb = luma + (rgb - luma) * saturation;
  rgb *= vec3(1.0 + 0.12 * warmth, 1.0, 1.0 - 0.15 * warmth);
  rgb = rgb * (1.0 + 0.6 * (clamp(lit, 0.3, 1.8) - 1.0)) + gloss * max(shine, 0.0);
  if (hasFocus) {
    rgb = mix(rgb, texelFetch(frame, p, 0).rgb, texelFetch(normalFocus, p, 0).a);
  }
  picture = vec4(clamp(rgb, 0.0, 1.0), 1.0);
}
