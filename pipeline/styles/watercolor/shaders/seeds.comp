// Purpose: carries every seed with its anchor and gives its place in this image.
// Inputs:  anchors (marks/anchors/shaders/anchor.glsl), seeds (seed.glsl), tilingThen (tiling_word.glsl) if
//          hasThen: the previous frame's tiling; slots; carries: whether the anchors have moved
//          since the last time; beginsAnew: all seeds are new; full: the full image's size in px;
//          pixelsOfFull; reach: the largest distance of a seed from its anchor, px of the full
//          image; growth: the penalty of an anchor that has not faded in, px² of this image;
//          mover_labels.glsl's if hasMovers.
// Outputs: seeds; points (seed_point.glsl); moverGroups: of tile.comp's dispatch for movers: the last
//          of its three numbers is set to 1 if there is a seed of one.
// Precision: points are rounded to their lattice.
#include "pipeline/marks/anchors/shaders/anchor.glsl"
#include "pipeline/marks/movers/shaders/mover_labels.glsl"
#include "pipeline/styles/watercolor/shaders/seed.glsl"
#include "pipeline/styles/watercolor/shaders/seed_point.glsl"
#include "pipeline/styles/watercolor/shaders/tiling_word.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Anchors { Anchor anchors[]; };
// volatile: docs/gpu.md, rule 22
layout(std430, binding = 1) volatile buffer Seeds { Seed seeds[]; };
layout(std430, binding = 2) volatile writeonly buffer Points { ivec4 points[]; };
layout(std430, binding = 3) volatile writeonly buffer MoverGroups { uint moverGroups[]; };
uniform highp usampler2D tilingThen;
uniform bool hasThen;
uniform int slots;
uniform bool carries;
uniform bool beginsAnew;
uniform vec2 full;
uniform vec2 pixelsOfFull;
uniform float reach;
uniform float growth;
uniform bool hasMovers;

const float kFarAway = 16384.0;  // px; keeps the lattice within integers

uint cellThen(vec2 px) {
  ivec2 size = textureSize(tilingThen, 0);
  ivec2 at = clamp(ivec2(px / full * vec2(size)), ivec2(0), size - 1);
  return slotOf(texelFetch(tilingThen, at, 0).r) + 1u;
}

Seed born(Anchor anchor) {
  uint parent = hasThen && !beginsAnew ? cellThen(anchor.px - anchor.displacement) : 0u;
  return Seed(vec2(0.0), 0.0, kBornSeed | kLiving, parent, 0u, 0u, 0u);
}

Seed carried(Seed seed, Anchor anchor) {
  vec2 offset = mat2(anchor.jacobian.xy, anchor.jacobian.zw) * seed.offset;
  float far = length(offset);
  seed.offset = far > reach ? offset * (reach / far) : offset;
  seed.state &= ~kBornSeed;
  return seed;
}

// What a mover leaves of a cell says nothing about where its seed belongs. Where the mover has passed,
// the cells are the same again.
bool isHeld(Anchor anchor) {
  if (!hasMovers || (anchor.state & kMover) != 0u) return false;
  return (anchor.state & kCovered) != 0u || nearestMover(anchor.px, 1.5 * reach) > 0.1;
}

void store(int slot, ivec4 point) {
  points[slot].xy = point.xy;
  points[slot].zw = point.zw;
}

void main() {
  int slot = int(gl_GlobalInvocationID.x);
  if (slot >= slots) return;
  Anchor anchor = anchors[slot];
  Seed seed = seeds[slot];
  if (!isAlive(anchor.state)) {
    seeds[slot].state = 0u;
    store(slot, kNoPoint);
    return;
  }
  if (carries) {
    bool isNew = beginsAnew || (anchor.state & kBorn) != 0u || (seed.state & kLiving) == 0u;
    seed = isNew ? born(anchor) : carried(seed, anchor);
    seed.state = (seed.state & ~kHeldSeed) | (isHeld(anchor) ? kHeldSeed : 0u);
    seeds[slot].offset = seed.offset;
    seeds[slot].restless = seed.restless;
    seeds[slot].state = seed.state;
    seeds[slot].parent = seed.parent;
  }
  vec2 at = clamp((anchor.px + seed.offset) * pixelsOfFull, vec2(-kFarAway), vec2(kFarAway));
  float penalty = (1.0 - clamp(anchor.fade, 0.0, 1.0)) * growth;
  bool onMover = hasMovers && (anchor.state & kMover) != 0u;
  if (onMover) moverGroups[2] = 1u;
  store(slot, seedPoint(at, penalty, slot, onMover));
}
