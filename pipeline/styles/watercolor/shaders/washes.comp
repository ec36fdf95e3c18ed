// Purpose: a cell's two washes, the light one that is laid first and the dark one that is glazed over
//          it: the two colours and their shares that have the moments of the cell's pixels (moment
//          preserving thresholding: Tsai, 1985; Delp and Mitchell, 1979).
// Inputs:  moments (split.comp; emptied here for the next frame), guide, grid, cellPixels.
// Outputs: darkWash, lightWash (RGBA8): sRGB-coded; A of the light one: its share.
// Precision: highp; sums below 2^24 are exact.
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Moments { uint moments[]; };
layout(binding = 0, rgba8) writeonly uniform highp image2D darkWash;
layout(binding = 1, rgba8) writeonly uniform highp image2D lightWash;
uniform sampler2D guide;
uniform ivec2 grid;
uniform vec2 cellPixels;

const vec3 kLuma = vec3(0.25, 0.625, 0.125);  // split.comp's, in levels
const float kLeastSpread = 3.0;  // levels: below, a cell is of one colour

void main() {
  ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(cell, grid))) return;
  int base = (cell.y * grid.x + cell.x) * 8;
  float count = float(moments[base + 3]);
  // A cell without a pixel of the guide has the colour at its place.
  vec2 middle = (vec2(cell) + 0.5) * cellPixels;
  vec3 dark = texelFetch(guide, min(ivec2(0.5 * middle), textureSize(guide, 0) - 1), 0).rgb;
  vec3 light = dark;
  float share = 0.5;
  if (count > 0.0) {
    vec3 mean = vec3(uvec3(moments[base], moments[base + 1], moments[base + 2])) / count;
    vec3 byLuma = vec3(uvec3(moments[base + 4], moments[base + 5], moments[base + 6])) / (8.0 * count);
    float cube = float(moments[base + 7]) * 16.0 / count;
    float m = dot(mean, kLuma);
    float variance = dot(byLuma, kLuma) - m * m;
    dark = light = mean / 255.0;
    if (variance > kLeastSpread * kLeastSpread) {
      float spread = sqrt(variance);
      float third = cube - 3.0 * m * variance - m * m * m;
      float skew = clamp(third / (variance * spread), -4.0, 4.0);
      float up = 0.5 * (skew + sqrt(skew * skew + 4.0));  // the light colour, in spreads
      vec3 slope = (byLuma - m * mean) / variance;        // of colour over luma
      light = clamp((mean + slope * spread * up) / 255.0, 0.0, 1.0);
      dark = clamp((mean - slope * spread / up) / 255.0, 0.0, 1.0);
      share = 1.0 / (1.0 + up * up);
    }
  }
  imageStore(darkWash, cell, vec4(dark, 1.0));
  imageStore(lightWash, cell, vec4(light, share));
  for (int i = 0; i < 8; ++i) moments[base + i] = 0u;
}
