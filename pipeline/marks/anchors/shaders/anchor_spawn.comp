// Purpose: spawns anchors in a cell, each in a part of it without one (thesis §4.3.1: jittered), on
//          the visible content there: the exact point of the surface behind the pixel (thesis §5.3)
//          of a model or of a real thing, or else a place of the camera image.
// Inputs:  anchor_cells.glsl's; births and slots (anchor_plan.comp); ids, barycentrics (ArFrame)
//          and their pixelsOfFull if hasObjects; fullSize; salt: another one each frame; atOnce:
//          whether anchors appear without a fade; target: of a cell;
//          scale: of the image, in octaves; depth and depthRange, near and far in metres, 0: no depth;
//          focalPx: of the full image; motion: MotionField's field; forms, surfaceMotion
//          (ArFrame), patches, patchesBefore: TensorField's, with patchPixels a side, if
//          hasPatches; mover_labels.glsl's, mover_shares.glsl's; picture (ArFrame::camera(), LINEAR),
//          accentPixels: births in the camera's image prefer what is narrower, px of the full image,
//          0: they do not.
// Outputs: anchors; counts cleared for the next frame. One invocation per cell.
// Precision: highp.
#include "pipeline/gpu/shaders/hash.glsl"
#include "pipeline/marks/anchors/shaders/accent.glsl"
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/anchor_cells.glsl"
#include "pipeline/marks/anchors/shaders/anchor_slots.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
uniform highp usampler2D ids;
uniform highp usampler2D barycentrics;
uniform bool hasObjects;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform uint salt;
uniform bool atOnce;
uniform highp sampler2D motion;
uniform highp usampler2D forms;
uniform highp sampler2D surfaceMotion;
uniform highp usampler2D patches;
uniform highp usampler2D patchesBefore;
uniform bool hasPatches;
uniform float patchPixels;
uniform highp sampler2D depth;
uniform vec2 depthRange;
uniform float focalPx;
uniform float scale;
uniform int target;
uniform highp sampler2D picture;
uniform float accentPixels;
#include "pipeline/scene/render/shaders/surface_form.glsl"

#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/marks/movers/shaders/mover_shares.glsl"

const int kScan = 8;  // places along a cell's side
const int kTries = 6;  // attempts in one part of the cell, then as many in the whole cell
const int kAccentTries = 8;  // before these, in that part, to find something narrow

ivec2 pixelAt(vec2 px) {
  return clamp(ivec2(floor(px * pixelsOfFull)), ivec2(0), textureSize(ids, 0) - 1);
}

// The next free part of the cell that is not in `taken`; any part if all are. One colour of a
// chequerboard over all cells is filled first: then nearly every square of a cell's size holds an
// anchor, wherever it moves, and a pan spawns few.
int freePart(ivec2 cell, uint taken, uint hash) {
  int parts = strataSide * strataSide;
  int first = int(hash % uint(parts));
  int spare = -1;
  for (int i = 0; i < parts; ++i) {
    int part = (first + i) % parts;
    if ((taken & (1u << uint(part))) != 0u) continue;
    ivec2 at = cell * strataSide + ivec2(part % strataSide, part / strataSide);
    if (((at.x + at.y) & 1) == 0) return part;
    spare = spare < 0 ? part : spare;
  }
  return spare < 0 ? first : spare;
}

// Whether the content has just entered the image. Its marks appear without a fade.
bool hasComeIn(vec2 px) {
  vec4 moved = textureLod(motion, px / fullSize, 0.0);
  vec2 from = px - moved.xy;
  return any(lessThan(from, vec2(0.0))) || any(greaterThanEqual(from, fullSize));
}

uint labelAt(vec2 px) { return labelOf(texelFetch(forms, pixelAt(px), 0).r); }

// Whether a model's surface has just come to sight from behind something. Its marks appear without
// a fade: nothing of its own lies beneath them.
bool hasBeenUncovered(vec2 px) {
  ivec2 pixel = pixelAt(px);
  uint label = labelAt(px);
  if (!hasPatches || label == 0u) return false;
  // A narrow patch is in no region's majority: nothing is known of where it was.
  ivec2 last = textureSize(patchesBefore, 0) - 1;
  ivec2 region = min(ivec2(px / patchPixels), last);
  if (labelOf(texelFetch(patches, region, 0).r) != label) return false;
  vec4 moved = texelFetch(surfaceMotion, pixel, 0);
  if (moved.w == 0.0) return false;
  ivec2 was = ivec2(floor((px - moved.xy / pixelsOfFull) / patchPixels));
  for (int i = 0; i < 9; ++i) {
    ivec2 at = clamp(was + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
    if (labelOf(texelFetch(patchesBefore, at, 0).r) == label) return false;
  }
  return true;
}

// Whether a model has just uncovered a place of the camera image.
bool hasModelLeft(vec2 px) {
  if (!hasPatches) return false;
  ivec2 last = textureSize(patchesBefore, 0) - 1;
  ivec2 was = ivec2(floor((px - textureLod(motion, px / fullSize, 0.0).xy) / patchPixels));
  for (int i = 0; i < 9; ++i) {
    ivec2 at = clamp(was + ivec2(i % 3, i / 3) - 1, ivec2(0), last);
    if (labelOf(texelFetch(patchesBefore, at, 0).r) != 0u) return true;
  }
  return false;
}

float metresAt(ivec2 pixel) {
  float ndc = 2.0 * texelFetch(depth, pixel, 0).r - 1.0;
  float near = depthRange.x;
  float far = depthRange.y;
  return 2.0 * far * near / (far + near - ndc * (far - near));
}

// Octaves of a model's px per metre.
float objectScaleAt(vec2 px) {
  if (depthRange.y <= 0.0) return scale;
  return log2(focalPx / max(metresAt(pixelAt(px)), 1e-3));
}

// Where a cell with its target of anchors comes to show s times the length on each side, 1 / s^2 of
// them are to remain. So the anchor that is the part u of the target from the lowest is needed from
// the scale sqrt(u) on, as compared to now. Neighbouring cells have parts far apart (Roberts, "The
// unreasonable effectiveness of quasirandom sequences", 2018), so that what remains is spread evenly.
uint rankOfBirth(ivec2 cell, uint before, float factor, float octaves) {
  vec2 lattice = vec2(cell) * vec2(0.7548776662, 0.5698402910);
  float within = fract(lattice.x + lattice.y + float(salt & 1023u) * 0.6180339887);
  float part = (float(before) + max(within, 1.0 / 64.0)) / (factor * float(target));
  return rankAt(octaves + 0.5 * log2(part));
}

// The mean of four pixels of the camera's image: noise of one of them is nothing narrow.
vec3 pictureAt(vec2 px) {
  return textureLod(picture, round(px * pixelsOfFull) / vec2(textureSize(picture, 0)), 0.0).rgb;
}

// Whether the camera's image shows something narrow there, of another colour than what is on both
// sides of it.
bool isOnAccent(vec2 px) {
  vec3 own = pictureAt(px);
  float most = 0.0;
  for (int i = 0; i < 2; ++i) {
    vec2 arm = accentPixels * vec2(1 - i, i);
    most = max(most, narrowness(pictureAt(px - arm) - own, pictureAt(px + arm) - own));
  }
  return most > kNewAccent;
}

// `patchesTaken`: those that the anchor is not to lie on; its own is added.
// `before`: how many anchors of its kind the cell has; `factor`: of their target.
void spawn(ivec2 cell, uint number, uint before, float factor, bool onObject, bool onMover,
           inout uint taken, inout uint patchesTaken) {
  if (number >= freeCount) return;
  uint hash = hashOf(cell, hashOf(salt) + number);  // separates the sequences of different frames
  int part = freePart(cell, taken, hash);
  taken |= 1u << uint(part);
  vec2 corner = vec2(part % strataSide, part / strataSide);
  uint id = 0u;
  vec2 px = vec2(0.0);
  vec2 mover = vec2(0.0);
  bool isFound = false;
  int scanned = patchesTaken != 0u ? kScan * kScan : 0;
  int accents = onObject || onMover || accentPixels <= 0.0 ? 0 : kAccentTries;
  for (int i = -accents; i < 2 * kTries + scanned && !isFound; ++i) {
    hash = hashOf(hash);
    vec2 jitter = vec2(unitOf(hash), unitOf(hashOf(hash)));
    vec2 inCell = i < kTries ? (corner + 0.1 + 0.8 * jitter) / float(strataSide) : jitter;
    if (i >= 2 * kTries) {
      // A small patch that chance has missed is found place by place.
      int place = i - 2 * kTries;
      inCell = (vec2(place % kScan, place / kScan) + jitter) / float(kScan);
    }
    px = (vec2(cell) + inCell) * float(cellPixels);
    if (any(greaterThanEqual(px, fullSize))) continue;
    id = hasObjects ? texelFetch(ids, pixelAt(px), 0).r : 0u;
    mover = moverAt(px);
    bool isMover = !isVirtual(objectOf(id)) && mover.r > 0.5;
    isFound = isVirtual(objectOf(id)) == onObject && isMover == onMover &&
              !(onObject && (patchesTaken & patchBit(labelAt(px))) != 0u);
    if (i < 0) isFound = isFound && isOnAccent(px);
  }
  if (!isFound) return;
  if (onObject) patchesTaken |= patchBit(labelAt(px));
  Anchor born;
  born.px = px;
  born.displacement = vec2(0.0);
  born.jacobian = vec4(1.0, 0.0, 0.0, 1.0);
  born.barycentrics = 0u;
  born.appearance = 0u;
  born.error = 0.0;
  born.fade = atOnce || onMover || mover.g > 0.0 || hasComeIn(px) ||
                      (onObject ? hasBeenUncovered(px) : hasModelLeft(px))
                  ? 1.0 : 0.0;
  born.ageAndRank = rankOfBirth(cell, before, factor, onObject ? objectScaleAt(px) : scale) << 16u;
  // independent of the place, which came from the same hash
  born.seed = hashOf(hash ^ 0x9E3779B9u);
  born.surface = onMover ? 0u : id;  // a mover is before all real things
  born.state = kAlive | kBorn | kSourceUnknown | (onMover ? stateOnMover(max(numberOf(sharesAt(px)), 1)) : 0u);
  if (born.surface != 0u) {
    ivec2 pixel = pixelAt(px);
    born.px = (vec2(pixel) + 0.5) / pixelsOfFull;
    born.barycentrics = texelFetch(barycentrics, pixel, 0).r;
    born.state |= kOnSurface;
  }
  anchors[freeSlots[number]] = born;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!isInGrid(at)) return;
  int index = indexOf(at);
  uint births = cells[index].births;
  uint strata = cells[index].strata;
  uint painted = cells[index].patches;
  uint inImage = cells[index].inImage;
  uint onObjects = cells[index].onObjects;
  uint onMovers = cells[index].onMovers;
  cells[index].patches = 0u;
  cells[index].strata = 0u;
  cells[index].inImage = 0u;
  cells[index].onObjects = 0u;
  cells[index].nextInImage = 0u;
  cells[index].nextOnObjects = 0u;
  cells[index].crowdedPatches = 0u;
  cells[index].dormant = 0u;
  cells[index].underModels = 0u;
  cells[index].nextUnderModels = 0u;
  uint moverBirths = cells[index].moverBirths;
  cells[index].onMovers = 0u;
  cells[index].nextOnMovers = 0u;
  if (cells[index].nextToWake != 0u) {
    uint slot = slotOf(cells[index].nextToWake);
    cells[index].nextToWake = 0u;
    anchors[slot].fade = atOnce || hasComeIn(anchors[slot].px) || hasBeenUncovered(anchors[slot].px)
                             ? 1.0 : 0.0;
  }
  bool hasBirths = birthsInImage(births) + birthsOnObjects(births) + birthsOnPatches(births) > 0u;
  if (!hasBirths && birthsInImage(moverBirths) == 0u) return;
  uint number = cells[index].firstBirth;
  uint any = 0u;
  uint taken = strata & 0xFFFFu;
  for (uint i = 0u; i < birthsInImage(births); ++i) {
    spawn(at, number++, inImage++, factorOf(births), false, false, taken, any);
  }
  taken = strata >> 16u;
  for (uint i = 0u; i < birthsOnPatches(births); ++i) {
    spawn(at, number++, onObjects++, 1.0, true, false, taken, painted);
  }
  for (uint i = 0u; i < birthsOnObjects(births); ++i) {
    any = 0u;
    spawn(at, number++, onObjects++, 1.0, true, false, taken, any);
  }
  taken = 0u;
  for (uint i = 0u; i < birthsInImage(moverBirths); ++i) {
    spawn(at, number++, onMovers++, factorOf(moverBirths), false, true, taken, any);
  }
}
