// Purpose: debug view of the camera image's features over the pale picture: a ring where each is,
//          and a line from where it was in the previous frame (thesis figure 18).
// Inputs:  picture; features: a texel each, where it was and where it is, px of the full image, for
//          the first `count` texels; size and pixelsOfFull: of the frame.
// Outputs: RGBA8, sRGB-coded, opaque. Precision: highp for places.
uniform sampler2D picture;
uniform highp sampler2D features;
uniform int count;
uniform vec2 size;
uniform vec2 pixelsOfFull;
layout(location = 0) out vec4 colour;

const float kRing = 4.0;       // px
const float kLineWidth = 1.2;  // px

float fromSegment(vec2 px, vec2 a, vec2 b) {
  vec2 along = b - a;
  float part = clamp(dot(px - a, along) / max(dot(along, along), 1e-6), 0.0, 1.0);
  return distance(px, a + part * along);
}

void main() {
  vec2 px = gl_FragCoord.xy / pixelsOfFull;
  float line = 1e6;
  float ring = 1e6;
  for (int i = 0; i < count; ++i) {
    vec4 feature = texelFetch(features, ivec2(i, 0), 0);
    line = min(line, fromSegment(px, feature.xy, feature.zw));
    ring = min(ring, abs(distance(px, feature.zw) - kRing));
  }
  vec3 shown = 0.55 + 0.45 * texture(picture, gl_FragCoord.xy / size).rgb;
  shown = mix(vec3(0.1, 0.3, 0.8), shown, smoothstep(0.5 * kLineWidth, 1.5 * kLineWidth, ring));
  shown = mix(vec3(0.85, 0.1, 0.1), shown, smoothstep(0.5 * kLineWidth, 1.5 * kLineWidth, line));
  colour = vec4(shown, 1.0);
}
