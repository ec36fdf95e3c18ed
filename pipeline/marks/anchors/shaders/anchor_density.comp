// Purpose: controls the density of anchors in a cell: the number of spawns, the anchor to remove and
//          the dormant one to wake (thesis §5.3, with hysteresis).
// Inputs:  anchor_cells.glsl's; the rule (marks::DensityRule): target, birthBelow, deathAbove: on
//          movers only if hasMoverSlack, else the target holds there; detailField and moverField
//          (TensorField), each with its scale, px of the full image to texture coordinates, and
//          detailRange, from and up to which their detail multiplies the rule's numbers, by
//          detailFactor at most; ids and forms (ArFrame) and
//          their pixelsOfFull if hasObjects, within objectBounds; fullSize; mover_labels.glsl's and
//          fidelity.glsl's,
//          and faithfulFactor: where fidelity is 1, the numbers are multiplied by this.
//          Anchors of the background and of movers are counted apart; each patch of a model that
//          shows enough of itself gets one at least; joints count less.
// Outputs: births of each cell; anchors: those to remove, and dormant ones that wake; nextToWake: 0
//          where none does. One invocation per cell.
// Precision: integers; highp for places.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/anchors/shaders/anchor_cells.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_form.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) buffer Anchors { Anchor anchors[]; };
layout(std430, binding = 1) buffer Cells { Cell cells[]; };
uniform highp usampler2D ids;
uniform highp usampler2D forms;
uniform bool hasObjects;
uniform vec4 objectBounds;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform int target;
uniform int birthBelow;
uniform int deathAbove;
uniform bool hasMoverSlack;
uniform highp sampler2D detailField;
uniform vec2 detailScale;
uniform highp sampler2D moverField;
uniform vec2 moverScale;
uniform float detailFactor;
uniform vec2 detailRange;
uniform float faithfulFactor;
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/marks/shaders/fidelity.glsl"

const float kMinShare = 0.12;  // of a cell: a smaller part gets no anchor of its own

const int kMaxPatches = 6;  // that are told apart in a cell

const float kFaithful = 0.5;  // fidelity from which cells are kept at their target

const int kBesideJoints = 3;  // so much more a pixel counts there: strokes cross joints

// What models show in a cell.
struct Objects {
  float share;     // of the cell
  uint patches;    // how many show enough of themselves
  uint unpainted;  // how many of these have no anchor
};

Objects objectsIn(ivec2 cell, uint painted) {
  ivec2 low = ivec2(floor(vec2(cell * cellPixels) * pixelsOfFull));
  ivec2 high = min(ivec2(ceil(vec2((cell + 1) * cellPixels) * pixelsOfFull)), textureSize(ids, 0));
  if (any(greaterThanEqual(vec2(low), objectBounds.zw)) ||
      any(lessThan(vec2(high), objectBounds.xy))) {
    return Objects(0.0, 0u, 0u);
  }
  int stride = max(1, (high.y - low.y) / 8);
  int shown = 0;
  int seen = 0;
  uint labels[kMaxPatches];
  int counts[kMaxPatches];
  int known = 0;
  for (int y = low.y; y < high.y; y += stride) {
    for (int x = low.x; x < high.x; x += stride) {
      ++seen;
      if (!isVirtual(objectOf(texelFetch(ids, ivec2(x, y), 0).r))) continue;
      ++shown;
      uint form = texelFetch(forms, ivec2(x, y), 0).r;
      int weight = (form & kAtJoint) != 0u ? 1 : kBesideJoints;
      uint label = labelOf(form);
      int i = 0;
      while (i < known && labels[i] != label) ++i;
      if (i == kMaxPatches) {
        // The smallest so far makes room, so that slivers at the top hide nothing larger below.
        i = 0;
        for (int k = 1; k < kMaxPatches; ++k) i = counts[k] < counts[i] ? k : i;
        labels[i] = label;
        counts[i] = 0;
      }
      if (i == known) {
        labels[i] = label;
        counts[i] = 0;
        ++known;
      }
      counts[i] += weight;
    }
  }
  Objects found = Objects(seen == 0 ? 0.0 : float(shown) / float(seen), 0u, 0u);
  for (int i = 0; i < known; ++i) {
    if (float(counts[i]) < float(kBesideJoints) * kMinShare * float(seen)) continue;
    ++found.patches;
    if ((painted & patchBit(labels[i])) == 0u) ++found.unpainted;
  }
  return found;
}

// The part of the cell that movers cover.
float moverShare(ivec2 cell) {
  float sum = 0.0;
  for (int i = 0; i < 9; ++i) {
    vec2 px = (vec2(cell) + (vec2(i % 3, i / 3) + 0.5) / 3.0) * float(cellPixels);
    sum += moverAt(px).r;
  }
  return sum / 9.0;
}

// By which factor a cell's numbers are larger for what detail it has: X: of the background, Y: of
// movers.
vec2 factorsOf(ivec2 cell) {
  vec2 px = (vec2(cell) + 0.5) * float(cellPixels);
  vec2 detail = vec2(textureLod(detailField, px * detailScale, 0.0).w,
                     textureLod(moverField, px * moverScale, 0.0).w);
  vec2 factors = 1.0 + (detailFactor - 1.0) * smoothstep(vec2(detailRange.x), vec2(detailRange.y), detail);
  return max(factors, vec2(mix(1.0, faithfulFactor, fidelityAt(px))));
}

uint rounded(float number) { return uint(number + 0.5); }

// Whether the surrounding cells hold their target. An empty cell among them is then a gap by
// chance, and filling it would crowd them later.
bool isAmongFull(ivec2 cell) {
  uint around = 0u;
  float factors = 0.0;
  float number = 0.0;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = cell + ivec2(x, y);
      if (!isInGrid(at)) continue;
      around += cells[indexOf(at)].inImage + cells[indexOf(at)].onObjects;
      factors += factorsOf(at).x;
      number += 1.0;
    }
  }
  return float(around) >= 8.0 * factors / number * float(target);
}

// The patches that have anchors in the cell or beside it, whose strokes reach into it.
uint paintedAround(ivec2 cell) {
  uint painted = cells[indexOf(cell)].patches;
  for (int i = 0; i < 4; ++i) {
    ivec2 at = cell + (i < 2 ? ivec2(2 * i - 1, 0) : ivec2(0, 2 * i - 5));
    if (isInGrid(at)) painted |= cells[indexOf(at)].patches;
  }
  return painted;
}

// `factor`: of the numbers; `isTight`: the target is wanted, not just `birthBelow`.
uint wanted(float share, float factor, uint count, bool isGap, bool isTight) {
  if (share < kMinShare) return 0u;
  uint least = uint(max(1.0, floor(factor * share * float(isTight ? target : birthBelow) + 0.5)));
  uint full = uint(max(1.0, floor(factor * share * float(target) + 0.5)));
  if (count >= least || full <= count) return 0u;
  return isGap ? least - count : full - count;
}

// Whether a part of the cell holds fewer anchors than its target.
bool lacks(float share, uint count) {
  return share >= kMinShare && count < uint(max(1.0, floor(share * float(target) + 0.5)));
}

// Its mark has the same random properties as before; anchor_spawn.comp gives its fade.
void wake(uint slot) {
  anchors[slot].state = kAlive | kBorn | kOnSurface | kSourceUnknown;
  anchors[slot].ageAndRank &= ~kMaxAge;
  anchors[slot].displacement = vec2(0.0);
  anchors[slot].jacobian = vec4(1.0, 0.0, 0.0, 1.0);
  anchors[slot].error = 0.0;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (!isInGrid(at)) return;
  int index = indexOf(at);
  Cell cell = cells[index];
  Objects objects = Objects(0.0, 0u, 0u);
  if (hasObjects) objects = objectsIn(at, paintedAround(at));
  vec2 factors = factorsOf(at);
  // Each further patch may have an anchor of its own; room for it is made at its birth, so that no
  // other one has to go in the next frame.
  uint more = max(objects.patches, 1u) - 1u;
  uint most = rounded(mix(factors.x, 1.0, objects.share) * float(deathAbove));
  if (cell.inImage + cell.onObjects + objects.unpainted > most + more) {
    // Of the two kinds, the one that has more of its share.
    float ofObjects = float(cell.onObjects + objects.unpainted) * (1.0 - objects.share);
    bool isObject = cell.nextInImage == 0u ||
                    (cell.nextOnObjects != 0u && ofObjects >= float(cell.inImage) * objects.share);
    anchors[slotOf(isObject ? cell.nextOnObjects : cell.nextInImage)].state |= kDying;
  }
  if (cell.underModels > 0u && cell.inImage + cell.underModels > rounded(factors.x * float(deathAbove))) {
    anchors[slotOf(cell.nextUnderModels)].state |= kDying;
  }
  float moving = moverShare(at);
  uint mostOnMovers =
      rounded(hasMoverSlack ? factors.y * float(deathAbove) : factors.y * moving * float(target) + 2.0);
  if (cell.onMovers > mostOnMovers) anchors[slotOf(cell.nextOnMovers)].state |= kDying;
  // Border cells may be cut off.
  vec2 inside = clamp((fullSize - vec2(at * cellPixels)) / float(cellPixels), 0.0, 1.0);
  float whole = inside.x * inside.y;
  float share = objects.share;
  bool isGap = isAmongFull(at);
  // The strokes of those under models reach beyond them.
  bool isTight = fidelityAt((vec2(at) + 0.5) * float(cellPixels)) > kFaithful;
  uint inImage = wanted(whole * (1.0 - share), factors.x, cell.inImage + cell.underModels,
                        isGap && !isTight, isTight);
  uint onObjects = wanted(whole * share, 1.0, cell.onObjects, isGap, false);
  // A stroke paints its own patch only.
  uint onPatches = min(objects.unpainted, 255u);
  onObjects = max(onObjects, onPatches) - onPatches;
  // Dormant anchors wake before others are born, one a frame.
  uint sleeping = cell.dormant & 0xFFFFu;
  uint onEmpty = cell.dormant >> 16u;
  bool wakes = (onPatches > 0u && wakesOnEmptyPatch(cell.nextToWake)) ||
               (sleeping > 0u && lacks(whole * share, cell.onObjects));
  if (wakes) wake(slotOf(cell.nextToWake));
  cells[index].nextToWake = wakes ? cell.nextToWake : 0u;
  uint waking = min(onPatches, onEmpty);
  onPatches -= waking;
  onObjects -= min(onObjects, sleeping - waking);
  cells[index].births =
      birthsWith(inImage, factors.x) | min(onObjects, 255u) << 16u | onPatches << 24u;
  uint onMovers = wanted(whole * moving, factors.y, cell.onMovers, false, !hasMoverSlack);
  cells[index].moverBirths = birthsWith(onMovers, factors.y);
}
