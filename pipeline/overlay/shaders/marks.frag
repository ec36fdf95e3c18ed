// Purpose: marks the parts of a step in the painting: crisp where they are seen, an outline around them, hatched
//          where other parts hide them, and their ghosts.
// Inputs:  painted and composed (LINEAR), of any size; region (region.frag) and figure (figure.frag; G of ghosts), of
//          the output's size; outputSize; opacity; lineScale: px of the output for each of one 640 px wide.
// Outputs: RGBA8. Precision: highp for places, mediump for colours.
#include "pipeline/overlay/shaders/marking.glsl"

uniform sampler2D painted;
uniform sampler2D composed;
uniform sampler2D region;
uniform sampler2D figure;
uniform vec2 outputSize;
uniform float opacity;
uniform float lineScale;

layout(location = 0) out vec4 colour;

// overlay::PartLook
const int kFocus = 1;
const int kTint = 2;
const int kOutline = 3;

int lookAt(ivec2 p) {
  ivec2 last = textureSize(region, 0) - 1;
  return int(texelFetch(region, clamp(p, ivec2(0), last), 0).r * 255.0 + 0.5);
}

vec2 figureAt(ivec2 p) {
  ivec2 last = textureSize(figure, 0) - 1;
  return texelFetch(figure, clamp(p, ivec2(0), last), 0).rg;
}

// Whether the look, and a ghost, are within `radius` px, in 8 directions.
bvec2 near(ivec2 p, float radius) {
  bvec2 found = bvec2(false);
  for (int i = 0; i < 8; ++i) {
    float angle = 0.785398 * float(i);
    ivec2 q = p + ivec2(round(radius * vec2(cos(angle), sin(angle))));
    int look = lookAt(q);
    found.x = found.x || (look >= kFocus && look <= kOutline);
    found.y = found.y || figureAt(q).g > 0.0;
  }
  return found;
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec2 place = gl_FragCoord.xy / outputSize;
  vec3 paint = texture(painted, place).rgb;
  int look = lookAt(p);
  if (look == kFocus || look == kTint) {
    vec3 crisp = texture(composed, place).rgb;
    if (look == kTint) crisp = mix(crisp, kReserved, 0.35);
    colour = vec4(mix(paint, crisp, opacity), 1.0);
    return;
  }
  if (look == kOutline) {
    colour = vec4(paint, 1.0);
    return;
  }
  vec3 marked = paint;
  vec2 shown = figureAt(p);
  bool isGhost = shown.g > 0.0;
  if (shown.r > 0.0 && !isGhost) {
    float period = 7.0 * lineScale;
    float across = mod(gl_FragCoord.x + gl_FragCoord.y, period);
    if (across < 0.3 * period) marked = mix(marked, kReserved, 0.8);
  }
  if (isGhost) marked = mix(marked, kReserved * shown.g, 0.6);
  bvec2 isInner = near(p, max(1.0, 1.5 * lineScale));
  bvec2 isOuter = near(p, max(2.0, 3.0 * lineScale));
  if (!isGhost && isOuter.y) marked = mix(marked, kCasing, 0.6);
  if (!isGhost && isInner.y) marked = kReserved;
  if (isOuter.x) marked = kCasing;
  if (isInner.x) marked = kReserved;
  colour = vec4(mix(paint, marked, opacity), 1.0);
}
