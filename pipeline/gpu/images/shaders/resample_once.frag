// Purpose: resample.frag where one bilinear tap covers an output pixel: pictures that grow, or shrink to
//          half their sides at most. Software renderers pay dearly for the other's loops.
// Inputs:  picture (LINEAR), sourceOrigin and sourceScale: source px = origin + scale * output px.
// Outputs: RGBA8. Precision: highp for coordinates.
uniform sampler2D picture;
uniform vec2 sourceOrigin;
uniform vec2 sourceScale;

layout(location = 0) out vec4 colour;

void main() {
  vec2 at = sourceOrigin + sourceScale * gl_FragCoord.xy;
  colour = texture(picture, at / vec2(textureSize(picture, 0)));
}
