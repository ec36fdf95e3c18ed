// Purpose: the two layers of paint at a place, the light wash alone and with the dark glaze over
//          it, and the place's position between the two. All of it changes slowly enough for one
//          pixel per 2x2 of the image.
// Inputs:  guide (guide.frag), darkPigment and lightPigment (pigment.frag), both LINEAR;
//          gliding (gliding.frag); pixelsOfFull (ArFrame); hardness, gaps and variation (watercolor_parameters.h).
// Outputs: darkLayer, lightLayer (RGBA8): packed densities (density.glsl); A of the dark one: the
//          position, 0 all dark, 1 all light, as 0.5 x + 0.25; A of the light one: hardness of the
//          border.
// Precision: highp.
#include "pipeline/gpu/images/shaders/luma.glsl"
#include "pipeline/styles/watercolor/shaders/density.glsl"
uniform sampler2D guide;
uniform sampler2D darkPigment;
uniform sampler2D lightPigment;
uniform sampler2D gliding;
uniform float pixelsOfFull;
uniform float hardness;
uniform float gaps;
uniform float variation;
layout(location = 0) out vec4 darkLayer;
layout(location = 1) out vec4 lightLayer;

const float kGlidingSoftness = 0.4;  // what moves over the paper has softer borders

// Varies the amount of paint by the load of the brush; thick paint varies less.
vec3 loaded(vec3 density, float load, float glides) {
  float more = variation * (1.0 - glides) * (load - 0.5) * 1.6;
  return density * max(1.0 + more / (1.0 + 0.7 * lumaOf(density)), 0.2);
}

void main() {
  vec2 at = gl_FragCoord.xy / vec2(textureSize(guide, 0));
  vec3 seen = texelFetch(guide, ivec2(gl_FragCoord.xy), 0).rgb;
  vec4 dark = texture(darkPigment, at);
  vec4 light = texture(lightPigment, at);
  float glides = texture(gliding, at).r;

  // A hard border where the image changes abruptly from one colour to the other, a soft one where
  // it changes slowly, and none where the two are alike.
  vec3 apart = light.rgb - dark.rgb;
  float contrast = length(apart);
  vec3 axis = apart / max(contrast * contrast, 1.0e-4);
  float place = clamp(dot(seen - dark.rgb, axis), -0.5, 1.5);
  float slope = 0.5 * length(vec2(dot(dFdx(seen), axis), dot(dFdy(seen), axis)));
  slope *= pixelsOfFull;  // per px of the full image
  float striking = contrast / (0.3 + 0.8 * lumaOf(light.rgb));  // the eye sees ratios
  float hard = hardness * smoothstep(0.06, 0.25, striking) * smoothstep(0.02, 0.08, slope);
  hard *= 1.0 - kGlidingSoftness * glides;

  // A third colour, neither of the two nor between them.
  vec3 other = seen - dark.rgb - clamp(place, 0.0, 1.0) * apart;
  other *= smoothstep(0.03, 0.12, length(other));
  vec3 lightDensity = loaded(densityOf(light.rgb + other), light.a, glides);
  vec3 darkDensity = loaded(densityOf(dark.rgb + other), light.a, glides);

  // Leaves paper white where an empty brush stopped short of a wet border.
  float beside = hard * smoothstep(0.25, 0.6, contrast) * smoothstep(0.35, 0.55, place) *
                 (1.0 - smoothstep(0.8, 1.1, place));
  lightDensity *= 1.0 - beside * smoothstep(0.5 - 0.5 * gaps, 0.6 - 0.5 * gaps, 0.75 - light.a);

  place = mix(dark.a, place, smoothstep(0.02, 0.08, striking));
  darkLayer = vec4(packDensity(darkDensity), 0.5 * place + 0.25);
  lightLayer = vec4(packDensity(lightDensity), hard);
}
