// Purpose: ink on paper: the paper's tooth keeps dry ink from its hollows, but not on movers, over which
//          the paper would glide: there, all of it is as high as most is. What is in focus stays as the
//          camera sees it.
// Inputs:  ink (line.frag); contours (contours.frag); contourWeight; lift: how bare lines leave the
//          other side of edges; substrate.glsl's: the paper;
//          inkColour; colours: the image, colour: how much of it contours take; paperColour; tooth: how much the hollows stay bare; relief: how much of the
//          paper's relief is seen; mover_labels.glsl's; pixelsOfFull; frame, normalFocus if hasFocus.
// Outputs: RGBA8, sRGB-coded, opaque.
// Precision: highp for places.
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/styles/substrate/shaders/substrate.glsl"
uniform sampler2D ink;
uniform sampler2D contours;
uniform sampler2D frame;
uniform sampler2D normalFocus;
uniform bool hasFocus;
uniform sampler2D colours;
uniform float colour;
uniform float contourWeight;
uniform float lift;
uniform vec3 inkColour;
uniform vec3 paperColour;
uniform float tooth;
uniform float relief;
uniform vec2 pixelsOfFull;
layout(location = 0) out vec4 picture;

// Dry ink stays on the paper's heights; more of it reaches deeper.
float caught(float height, float amount) {
  float level = mix(0.75, 0.25, amount);
  return mix(1.0, smoothstep(level - 0.2, level + 0.2, height), tooth);
}

void main() {
  ivec2 p = ivec2(gl_FragCoord.xy);
  vec4 paper_ = sheetAt(onPaper(gl_FragCoord.xy), 1.0);
  vec4 lines = texelFetch(ink, p, 0);
  vec2 edge = texelFetch(contours, p, 0).rg;
  float contour = contourWeight * edge.r;
  lines *= 1.0 - lift * edge.g;
  // More of the ink: contours are to be seen on what they bound.
  vec3 contourInk = mix(inkColour, texelFetch(colours, p, 0).rgb, 0.5 * colour);
  float amount = 1.0 - (1.0 - lines.a) * (1.0 - contour);
  vec3 colour = (lines.rgb * (1.0 - contour) + contourInk * contour) / max(amount, 1e-4);
  if (tooth > 0.0) {
    float moving = movingAt(gl_FragCoord.xy / pixelsOfFull);
    amount *= caught(mix(paper_.r, 0.5, moving), amount);
  }
  vec3 sheet = paperColour * (1.0 + relief * (2.0 * paper_.g - 1.0));
  vec3 rgb = mix(sheet, colour, amount);
  if (hasFocus) rgb = mix(rgb, texelFetch(frame, p, 0).rgb, texelFetch(normalFocus, p, 0).a);
  picture = vec4(clamp(rgb, 0.0, 1.0), 1.0);
}
