// Purpose: which share of a pixel a mover covers, by the picture's own colours: labels are half as fine
//          as the full image, and their border trembles by a pixel or two where the picture's does not.
// Inputs:  mover_shares.glsl's; background (marks::MotionLayers::background()): mean colour, and in A
//          how many frames are in it; picture: the frame's.
// Outputs: functions.
// Precision: highp.
#include "pipeline/marks/movers/shaders/mover_shares.glsl"
uniform highp sampler2D background;

// The mover at a border between that alone and the ground, and its share of the pixel there.
struct Matte {
  int number;  // 0: this is no such border
  float share;
};

// The mover's share of a colour that is mixed of its own and the ground's.
float mixtureOf(float fromGround, float fromOwn, float contrast) {
  return clamp(0.5 * (fromGround - fromOwn) / contrast + 0.5, 0.0, 1.0);
}

// Three px on both sides of the labels' border, the share is that which mixes the pixel's colour from the
// mover's, farther inside, and the remembered one of the ground. Where that tells little, it is the labels'.
// `isNear`: whether there may be such a border: a loop of unknown length that no invocation enters costs
// little on software renderers.
Matte matteAt(vec2 px, bool isNear, highp sampler2D image, vec2 imageSize) {
  const float kReach = 2.0;   // px, beyond which labels are certain
  const float kInside = 4.0;  // px
  const float kLeastContrast = 0.05;
  const float kCertainContrast = 0.15;
  const float kEdge = 0.25;
  const float kNoise = 0.45;
  vec3 here = sharesAt(px);
  vec3 mean = 0.2 * here;
  mat3 slope = mat3(0.0);  // of each mover, in its rows
  for (int i = isNear ? 0 : 4; i < 4; ++i) {
    float along = i < 2 ? -1.0 : 1.0;
    vec2 aside = i % 2 == 0 ? vec2(along, 0.0) : vec2(0.0, along);
    vec3 there = sharesAt(px + kReach * aside);
    mean += 0.2 * there;
    slope += outerProduct(there, vec3(aside, 0.0));
  }
  int number = numberOf(mean);
  float around = shareOf(mean, number);
  bool isBorder = isNear && number != 0 && around < 0.999 && sumOf(mean) - around < 0.001;
  if (!isBorder) number = 0;
  float labelled = shareOf(here, number);
  float share = labelled;
  for (int i = isBorder ? 0 : 1; i < 1; ++i) {
    vec2 inwards = vec2(shareOf(slope[0], number), shareOf(slope[1], number));
    vec4 ground = textureLod(background, inLayers(background, px), 0.0);
    if (dot(inwards, inwards) < 0.01 || ground.a < 0.5) break;
    vec2 inside = px + kInside * normalize(inwards);
    vec3 nearby = vec3(0.0);
    vec3 own = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
      vec2 aside = vec2(k & 1, k >> 1) - 0.5;
      nearby += 0.25 * textureLod(image, (px + aside) / imageSize, 0.0).rgb;
      own += 0.25 * textureLod(image, (inside + aside) / imageSize, 0.0).rgb;
    }
    vec3 colour = textureLod(image, px / imageSize, 0.0).rgb;
    float contrast = max(apart(own, ground.rgb), 1e-3);
    float fromGround = apart(colour, ground.rgb);
    float fromOwn = apart(colour, own);
    float mixed = mixtureOf(fromGround, fromOwn, contrast);
    // At a straight edge, the mean around a pixel differs from it by a quarter; a single pixel from
    // which it differs by more is noise.
    float nearbyShare = mixtureOf(apart(nearby, ground.rgb), apart(nearby, own), contrast);
    mixed = mix(mixed, nearbyShare, smoothstep(kEdge, kNoise, abs(mixed - nearbyShare)));
    // A colour that is no mixture of the two is another part of the mover, or a shadow.
    float certain = smoothstep(kLeastContrast, kCertainContrast, contrast) *
                    (1.0 - smoothstep(1.2, 1.8, (fromGround + fromOwn) / contrast));
    share = clamp(mix(labelled, mixed, certain), smoothstep(0.7, 1.0, around),
                  smoothstep(0.0, 0.3, around));
  }
  return Matte(number, share);
}
