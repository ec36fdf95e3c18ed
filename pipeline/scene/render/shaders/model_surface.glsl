// Purpose: a model's lit surface, and the data that styles need of it; shared by opaque and
//          alpha-masked surfaces.
// Inputs:  cameraNormal, towardViewer, texturePlace, vertexColour, triangle; object, baseColour and
//          baseTexture (sampled as linear light), focus; those of shaded().
// Outputs: colour RGBA8, sRGB-coded; ids R32UI; normalFocus RGBA8 (scene/render/ar_frame.h).
// Precision: highp; bands are thresholds.
#include "pipeline/scene/render/shaders/object_id.glsl"

uniform uint object;
uniform vec4 baseColour;
uniform sampler2D baseTexture;
uniform float focus;

in vec3 cameraNormal;
in vec3 towardViewer;
in vec2 texturePlace;
in vec4 vertexColour;
flat in uint triangle;

layout(location = 0) out vec4 colour;
layout(location = 1) out uint ids;
layout(location = 2) out vec4 normalFocus;

// Returns an sRGB-coded colour. Defined in shading_toon.glsl or shading_smooth.glsl; a shader that
// includes this file includes one of those too.
vec3 shaded(vec3 linearRgb, vec3 n, vec3 towardViewer);

// Linear light and coverage.
vec4 surfaceColour() {
  return baseColour * vertexColour * texture(baseTexture, texturePlace);
}

void writeSurface(vec3 linearRgb) {
  vec3 n = normalize(cameraNormal);
  if (!gl_FrontFacing) n = -n;
  colour = vec4(shaded(linearRgb, n, normalize(towardViewer)), 1.0);
  ids = idOf(object, triangle);
  normalFocus = vec4(0.5 * n + 0.5, focus);
}
