// Purpose: the picture averaged over time along its motion (marks/steady_picture.h). One invocation
//          does a block of 4x4 pixels: the camera's picture moves by one displacement there, so that
//          its past needs 7x7 reads for all of them; pixels of objects follow their own.
// Inputs:  picture (RGBA8, sRGB-coded), past (this pass's output of the frame before, LINEAR),
//          backward (marks/motion_field.h); if kHasObjects, which who includes this says: ids, and
//          motion (ArFrame) if hasMotion; pixelsOfFull; kept: the part of the past's weight that this
//          frame leaves; noise: sigma.
// Outputs: steady (RGBA16F): colour; frames' worth of it, below 0 where a virtual object is seen.
// Precision: highp.
layout(local_size_x = 16, local_size_y = 4) in;
layout(binding = 0, rgba16f) writeonly uniform highp image2D steady;
uniform sampler2D picture;
uniform sampler2D past;
uniform sampler2D backward;
uniform sampler2D motion;
uniform highp usampler2D ids;
uniform bool hasMotion;
uniform vec2 pixelsOfFull;
uniform float kept;
uniform float noise;

const int kPixels = 16;
const uint kTriangleBits = 22u;  // scene::kTriangleBits
const uint kRealObject = 512u;   // scene::kRealObject
const float kFieldPixels = 8.0;  // marks::MotionField
const float kSpread = 1.5;       // of colours around a pixel: what the past may have
const float kNoiseSpread = 2.0;  // likewise, of the noise
const float kMostFrames = 64.0;

ivec2 size;
ivec2 corner;
vec4 before[kPixels];  // the past that belongs to each pixel
float trust[kPixels];
bool isVirtual[kPixels];

// How much the past counts whose place is known to so many px.
float trustOf(float error) { return 1.0 - smoothstep(0.75, 2.0, error); }

bool isInPicture(vec2 at) { return all(greaterThan(at, vec2(0.0))) && all(lessThan(at, vec2(size))); }

// Catmull-Rom's weights of the four texels around a place that is f beyond the second.
vec4 weightsOf(float f) {
  return vec4(((-0.5 * f + 1.0) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1.0,
              ((-1.5 * f + 2.0) * f + 0.5) * f, (0.5 * f - 0.5) * f * f);
}

void followPicture() {
  vec2 middle = (vec2(corner) + 2.0) / pixelsOfFull;
  vec2 fields = vec2(textureSize(backward, 0));
  vec4 moved = textureLod(backward, middle / (kFieldPixels * fields), 0.0);
  vec2 from = -moved.xy * pixelsOfFull;
  bool isKnown = moved.w > 0.5 && abs(from.x) < 4096.0 && abs(from.y) < 4096.0;
  from = isKnown ? from : vec2(0.0);
  float known = isKnown ? trustOf(moved.z * pixelsOfFull.x) : 0.0;
  vec2 whole = floor(from);
  vec4 across = weightsOf(from.x - whole.x);
  vec4 down = weightsOf(from.y - whole.y);
  ivec2 first = corner + ivec2(whole) - 1;
  for (int i = 0; i < kPixels; ++i) before[i] = vec4(0.0);
  for (int row = 0; row < 7; ++row) {
    vec4 line[7];
    for (int i = 0; i < 7; ++i) {
      line[i] = texelFetch(past, clamp(first + ivec2(i, row), ivec2(0), size - 1), 0);
    }
    for (int x = 0; x < 4; ++x) {
      vec4 value = across.x * line[x] + across.y * line[x + 1] + across.z * line[x + 2] +
                   across.w * line[x + 3];
      for (int y = 0; y < 4; ++y) {
        int tap = row - y;
        if (tap >= 0 && tap < 4) before[y * 4 + x] += down[tap] * value;
      }
    }
  }
  for (int i = 0; i < kPixels; ++i) {
    vec2 at = vec2(corner + ivec2(i & 3, i >> 2)) + 0.5 + from;
    trust[i] = isInPicture(at) ? known * max(before[i].a, 0.0) : 0.0;
    isVirtual[i] = false;
  }
}

// Where an object is seen its own motion leads back. No loop is left open here: arrays that are
// indexed at run time would cost more than all the rest.
void followObjects() {
  for (int i = 0; i < kPixels; ++i) {
    ivec2 p = min(corner + ivec2(i & 3, i >> 2), size - 1);
    uint object = texelFetch(ids, p, 0).r >> kTriangleBits;
    vec4 moved = hasMotion ? texelFetch(motion, p, 0) : vec4(0.0);
    bool isKnown = moved.w > 0.5;
    vec2 at = vec2(p) + 0.5 - (isKnown ? moved.xy : vec2(0.0));
    vec4 there = textureLod(past, at / vec2(size), 0.0);
    isVirtual[i] = object != 0u && object < kRealObject;
    float frames = isVirtual[i] ? -there.a : there.a;
    before[i] = object != 0u ? there : before[i];
    trust[i] = object == 0u ? trust[i]
             : isKnown && isInPicture(at) ? trustOf(moved.z) * max(frames, 0.0) : 0.0;
  }
}

void main() {
  size = textureSize(picture, 0);
  corner = ivec2(gl_GlobalInvocationID.xy) * 4;
  if (any(greaterThanEqual(corner, size))) return;
  followPicture();
  if (kHasObjects) followObjects();

  vec3 around[36];
  for (int i = 0; i < 36; ++i) {
    ivec2 p = clamp(corner + ivec2(i % 6, i / 6) - 1, ivec2(0), size - 1);
    around[i] = texelFetch(picture, p, 0).rgb;
  }
  vec3 sums[24];  // of three in a row: colours, then their squares
  vec3 squares[24];
  for (int i = 0; i < 24; ++i) {
    int at = (i >> 2) * 6 + (i & 3);
    vec3 a = around[at];
    vec3 b = around[at + 1];
    vec3 c = around[at + 2];
    sums[i] = a + b + c;
    squares[i] = a * a + b * b + c * c;
  }
  for (int i = 0; i < kPixels; ++i) {
    vec3 mean = (sums[i] + sums[i + 4] + sums[i + 8]) * (1.0 / 9.0);
    vec3 square = (squares[i] + squares[i + 4] + squares[i + 8]) * (1.0 / 9.0);
    vec3 reach = kSpread * sqrt(max(square - mean * mean, 0.0)) + kNoiseSpread * noise;
    vec3 now = around[(i >> 2) * 6 + (i & 3) + 7];
    vec3 then = clamp(before[i].rgb, mean - reach, mean + reach);
    float frames = kept > 0.0 ? kept * min(trust[i], kMostFrames) : 0.0;  // no past: no NaN of it
    vec3 colour = frames > 0.0 ? (now + frames * then) / (1.0 + frames) : now;
    float total = isVirtual[i] ? -1.0 - frames : 1.0 + frames;
    // Beyond the border: no effect.
    imageStore(steady, corner + ivec2(i & 3, i >> 2), vec4(colour, total));
  }
}
