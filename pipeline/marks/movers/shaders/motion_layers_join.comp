// Purpose: decides which cells belong to movers, from all that motion_layers.comp found around
//          each, and adds the others to the background (marks/movers/motion_layers.h), in the blocks where
//          there is other content.
// Inputs:  motion_layers.glsl's, motion_layers_tally.glsl's, background_activity.glsl's;
//          candidates, evidence (motion_layers.comp); ground (motion_layers_ground.comp); picture:
//          this frame's, in cells; background: the previous frame's; restSeconds: after so long a mover
//          that rests joins the background, frontRestSeconds: if it is before a model; front: the
//          previous frame's (front_movers.comp), if hasFront; inPlace (mover_in_place.comp);
//          isDoubted: what is remembered may be a mover that stood there when the camera began to
//          look; freshSeconds: freshness falls to 0
//          within so long; noise: sigma of a cell, in [0, 1].
// Outputs: labels RGBA16F: 1 on movers, else 0; freshness: 1 where the label has just changed,
//          falling to 0; rest and maturity, s, the latter below 0 where a mover has left.
//          backgroundNow RGBA16F: its mean colour, and the frames in the mean, 0 if it was never
//          seen. activityNow R32F: this frame's backgroundActivity. A group of invocations per
//          block of the second list of busy_blocks.glsl.
// Precision: highp.
#include "pipeline/marks/movers/shaders/background_mean.glsl"
#include "pipeline/marks/movers/shaders/busy_blocks.glsl"
#include "pipeline/marks/movers/shaders/motion_layers.glsl"
#include "pipeline/marks/movers/shaders/motion_layers_tally.glsl"
#include "pipeline/marks/tensors/shaders/structure.glsl"
#include "pipeline/marks/movers/shaders/background_activity.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(rgba16f, binding = 0) writeonly uniform highp image2D labels;
layout(rgba16f, binding = 1) writeonly uniform highp image2D backgroundNow;
layout(r32f, binding = 2) writeonly uniform highp image2D activityNow;
uniform highp sampler2D candidates;
uniform highp sampler2D evidence;
uniform highp sampler2D picture;
uniform highp sampler2D background;
uniform highp sampler2D ground;
uniform highp sampler2D front;
uniform highp sampler2D inPlace;
uniform bool hasFront;
uniform bool isDoubted;
uniform float frontRestSeconds;
uniform float restSeconds;
uniform float freshSeconds;
uniform int reach;  // 1, of the cells around; a uniform, so that compilers keep loops over them
uniform float noise;

const float kHasLeft = -1.0;   // instead of a maturity: the motion of movers carries nothing here
const float kJoined = -1.0;    // s, instead of a rest: so long what has joined the background, or was
                               // other content and no mover, tells nothing of what is beside it
const float kTentative = 0.7;  // s: what has changed once and then rests is no mover
const float kLeastRest = 0.08;  // s, of what may have been uncovered
const float kRestingChange = 0.05;
const float kMovingRestingChange = 0.3;  // while the camera moves: its picture trembles
const float kMostOthers = 0.5;  // of the picture: if more is other content, the light has changed
const float kLeastOther = 0.15;
const float kLikelier = 0.06;  // of colour: uncovered rather than covered
const float kAlike = 0.6;      // share of the memory's difference that is left
const float kSwitched = 0.04;  // of all blocks: a light has been switched
const float kLeastKept = 0.5;   // of those with edges that have changed
const int kHoleReach = 8;  // cells
const int kOutlineReach = 4;  // cells: a mover that has left is taken back from its outline inwards
const float kHoleUnlike = 0.012;  // of colour: a hole in a mover that shows no background
const float kHoleDeviations = 1.5;  // of the noise, in a mean of nine
const int kCrackReach = 4;  // cells, to both sides
const float kCrackAlike = 0.03;  // of colour: what is seen goes on over a crack

// The colour of the background around, in a window that grows until it has seen enough, and how
// many blocks of it were seen.
vec4 surroundings(ivec2 cell) {
  const float kEnough = 4.0;  // blocks
  ivec2 size = textureSize(ground, 0);
  ivec2 block = min(cell / kLayerBlock, size - 1);
  vec4 sum = vec4(0.0);
  for (int stride = 1; stride <= 4 && sum.a < kEnough; stride *= 2) {
    sum = vec4(0.0);
    for (int y = -2 * reach; y <= 2 * reach; ++y) {
      for (int x = -2; x <= 2; ++x) {
        sum += texelFetch(ground, clamp(block + stride * ivec2(x, y), ivec2(0), size - 1), 0);
      }
    }
  }
  return vec4(sum.rgb / max(sum.a, 1e-3), sum.a);
}

// How long the parts of the same mover beside the cell have been seen to move: those whose colours
// are rather its own than the background's.
float maturityAround(ivec2 cell, ivec2 size, vec3 now, vec3 known) {
  const int kLeastSame = 3;  // of the nine: a straight border's
  float unlike = apart(now, known);
  float most = 0.0;
  int same = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(cell + 2 * ivec2(x, y), ivec2(0), size - 1);
      float there = texelFetch(evidence, at, 0).b;
      if (there <= kMatureSeconds) continue;
      if (apart(texelFetch(picture, at, 0).rgb, now) > kLikeMover * unlike) continue;
      most = max(most, there);
      ++same;
    }
  }
  return same < kLeastSame ? 0.0 : most;
}

// Whether a mover is within two cells that has been seen to move.
bool isBesideMature(ivec2 cell, ivec2 size) {
  float most = 0.0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(cell + 2 * ivec2(x, y), ivec2(0), size - 1);
      if (texelFetch(candidates, at, 0).g > 0.5) most = max(most, texelFetch(evidence, at, 0).b);
    }
  }
  return most > kMatureSeconds;
}

// Whether other content around the cell is like its surroundings, and what was remembered there is
// not: then that was the mover, and has left.
bool isUncovered(ivec2 cell, ivec2 size) {
  const float kLeastSeen = 1.0;  // blocks
  vec4 surrounding = surroundings(cell);
  if (surrounding.a < kLeastSeen) return false;
  vec3 around = surrounding.rgb;
  vec2 sum = vec2(0.0);  // how unlike they are: the memory, and what is seen
  float weights = 1e-3;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(cell + 2 * ivec2(x, y), ivec2(0), size - 1);
      float weight = texelFetch(candidates, at, 0).r;
      vec2 px = (vec2(at) + 0.5) * kLayerCellPixels;
      vec3 known = textureLod(background, inLayers(background, px - backgroundShift(px)), 0.0).rgb;
      vec3 there = texelFetch(picture, at, 0).rgb;
      sum += weight * vec2(apart(known, around), apart(there, around));
      weights += weight;
    }
  }
  return sum.x - sum.y > kLikelier * weights && sum.y < kAlike * sum.x;
}

// Whether what is seen goes on in the background beside it, and what was remembered does not: a
// mover was remembered, and has left. All of its place is found so from its outline inwards, some
// 16 px of the full image a frame. Holes in a mover are no background, nor are its parts that have
// joined.
bool continuesBackground(ivec2 cell, ivec2 size) {
  const float kLeastBeside = 3.0;  // of the nine
  const float kSpeck = 6.0;        // so many: nothing of a mover is around
  vec3 remembered = vec3(0.0);
  vec3 seen = vec3(0.0);
  vec4 beside = vec4(0.0);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(cell + ivec2(x, y), ivec2(0), size - 1);
      remembered += texelFetch(background, at, 0).rgb / 9.0;
      seen += texelFetch(picture, at, 0).rgb / 9.0;
    }
  }
  for (int stride = 1; stride <= 8 && beside.a < kLeastBeside; stride *= 2) {
    beside = vec4(0.0);
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -1; x <= 1; ++x) {
        ivec2 at = cell + stride * ivec2(x, y);
        if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) continue;
        vec4 there = texelFetch(candidates, at, 0);
        vec4 was = texelFetch(evidence, at, 0);
        bool isGround = there.r < kLeastOther && there.g < 0.1 && was.r >= 0.0 && was.g >= 0.0;
        if (!isGround) continue;
        beside += vec4(texelFetch(picture, at, 0).rgb, 1.0);
      }
    }
    if (stride == 1 && beside.a >= kSpeck) return true;
  }
  if (beside.a < kLeastBeside) return false;
  vec3 ground = beside.rgb / beside.a;
  float before = apart(remembered, ground);
  float now = apart(seen, ground);
  return before - now > kLikelier && now < kAlike * before;
}

// The movers on the eight sides of a cell. Each side has a bit, and opposite sides have neighbouring
// bits.
struct Sides {
  uint met;  // the image's border counts, too
  uint alike;  // those whose mover, mature and within kCrackReach, is of the cell's colour
  float maturity;  // of the one that has been seen to move for longest
};

// The sides of a cell within `farthest` cells. Steps of one parity would find no side of a hole in
// every second row.
Sides sidesOf(ivec2 cell, ivec2 size, int farthest) {
  Sides sides = Sides(0u, 0u, 0.0);
  for (int i = 0; i < 8 * reach; ++i) {
    ivec2 along = i < 2 ? ivec2(1, 0) : ivec2(i / 2 - 2, 1);
    if ((i & 1) != 0) along = -along;
    for (int away = 1; away <= farthest; away += 1 + away / 2) {
      ivec2 at = cell + away * along;
      bool isOutside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size));
      vec2 there = isOutside ? vec2(1.0) : texelFetch(candidates, at, 0).rg;
      if (there.g < 0.5 || there.r < 0.5) continue;
      sides.met |= 1u << i;
      if (isOutside) break;
      float maturity = texelFetch(evidence, at, 0).b;
      vec3 unlike = texelFetch(picture, at, 0).rgb - texelFetch(picture, cell, 0).rgb;
      bool isNear = maturity > kMatureSeconds && away <= kCrackReach;
      if (isNear && weightedLength(unlike) < kCrackAlike) sides.alike |= 1u << i;
      sides.maturity = max(sides.maturity, maturity);
      break;
    }
  }
  return sides;
}

bool isEnclosed(Sides sides) { return sides.met == 0xFFu; }

// Whether a mover's colours go on over the cell, from one side to the other. A mover that crosses
// things of its own colours looks like what is remembered there, along lines: cracks in its label.
bool isInCrack(Sides sides) { return (sides.alike & sides.alike >> 1u & 0x55u) != 0u; }

// Whether what is seen in a hole in a mover is not what is remembered there, though it is too like
// it, or too like its shadow, to be other content by itself: the mean over the hole around the cell.
bool isUnlikeInHole(ivec2 cell, ivec2 size) {
  vec4 sum = vec4(0.0);
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(cell + ivec2(x, y), ivec2(0), size - 1);
      vec4 known = texelFetch(background, at, 0);
      if (texelFetch(candidates, at, 0).r > 0.5 || known.a < 0.5) continue;
      sum += vec4(texelFetch(picture, at, 0).rgb - known.rgb, 1.0);
    }
  }
  float least = kHoleUnlike + kHoleDeviations * noise;
  return sum.a > 0.0 && weightedLength(sum.rgb / sum.a) > least;
}

void main() {
  if (isBeyond(kBusyCommand)) return;
  ivec2 block = blockOf(busyWords[busyAt(int(gl_WorkGroupID.x))]);
  ivec2 cell = block * kLayerBlock + ivec2(gl_LocalInvocationID.xy);
  ivec2 size = imageSize(labels);
  if (any(greaterThanEqual(cell, size))) return;
  vec4 past = texelFetch(evidence, cell, 0);
  vec4 own = texelFetch(candidates, cell, 0);
  float others = 0.0;
  float changes = 0.0;
  float carried = 0.0;
  Structure structure = noStructure();
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -1; x <= 1; ++x) {
      ivec2 at = clamp(cell + 2 * ivec2(x, y), ivec2(0), size - 1);
      vec4 there = texelFetch(candidates, at, 0);
      others += there.r / 9.0;
      carried = max(carried, there.g);
      changes += max(texelFetch(evidence, at, 0).r, 0.0) / 9.0;
      add(structure, there.ba);
    }
  }
  // A change of light leaves edges where they are.
  float blocks = float(size.x * size.y) / float(kLayerBlock * kLayerBlock);
  float kept = float(keptBlocks[turn]);
  bool isSwitched = kept > kSwitched * blocks && kept > kLeastKept * float(changedBlocks[turn]);
  bool isEverywhere = float(otherCells[turn]) > kMostOthers * float(size.x * size.y);
  bool isLight = isEverywhere || ((isSwitched || isSame(structure)) && carried <= 0.5);
  bool wasMover = own.g > 0.5;
  bool isOther = (own.r > 0.5 && others > 0.25) || (own.r > 0.15 && others > 0.55) || others > 0.8;
  bool hasCause = changes > 0.08 || carried > 0.5;
  bool isMover = !isLight && hasCause && (isOther || (wasMover && own.r > 0.15 && others > 0.3));
  bool mayBeHole = !isMover && !isEverywhere && !isSwitched && hasCause && carried > 0.5;
  bool mayContinue = isMover && isDoubted;
  Sides sides = Sides(0u, 0u, 0.0);
  if (mayBeHole || (isStanding && mayContinue)) {
    sides = sidesOf(cell, size, mayBeHole ? kHoleReach : kOutlineReach);
  }
  // What has just joined the background is no crack in what has yet to join.
  bool isCrack = past.g >= 0.0 && isInCrack(sides);
  bool isFilled = mayBeHole && (isCrack || (isStanding && isEnclosed(sides) &&
                                                     isUnlikeInHole(cell, size)));
  // A plain part does not change, though it moves: it does not rest.
  if (!isLight && texelFetch(inPlace, cell, 0).r > 0.5) {
    isFilled = isFilled || !isMover;
    changes = 1.0;
  }
  isMover = isMover || isFilled;
  bool isResting = changes < (isStanding ? kRestingChange : kMovingRestingChange);
  float rest = isMover && isResting ? max(past.g, 0.0) + stepSeconds : 0.0;
  float maturity = isMover ? max(past.b, isFilled ? sides.maturity : past.b) : 0.0;
  bool isYoung = isMover && !isFilled && maturity <= kMatureSeconds;
  // What was a mover when the camera began to look, or stood there for long, has left. Flow and the
  // motion of movers reach beyond their outlines: neither makes such a place older. While the camera
  // moves, new parts of a mover would be taken for such places.
  bool hasLeft = isYoung && isStanding && isUncovered(cell, size);
  vec2 px = (vec2(cell) + 0.5) * kLayerCellPixels;
  vec2 from = px - backgroundShift(px);
  vec3 now = texelFetch(picture, cell, 0).rgb;
  bool isAnother = past.r < 0.0;
  vec4 known = isInPicture(from) && !isAnother ? textureLod(background, inLayers(background, from), 0.0)
                                 : vec4(now, 0.0);
  if (!hasLeft && isYoung && known.a >= 0.5) {
    maturity = max(maturity, maturityAround(cell, size, now, known.rgb));
  }
  // Later, it would take a mover that rests beside things of its own colour for such a place.
  mayContinue = mayContinue && isStanding && rest > kLeastRest && !isEnclosed(sides);
  hasLeft = hasLeft || (mayContinue && continuesBackground(cell, size));
  if (hasLeft) maturity = kHasLeft;
  // A cell beside a mature mover joins no earlier than that mover, which crept over it when no motion
  // was measured.
  bool isLasting = maturity > kMatureSeconds;
  if (isMover && isStanding && !hasLeft && !isLasting) isLasting = isBesideMature(cell, size);
  float joinsAfter = hasLeft ? 0.0 : isLasting ? restSeconds : kTentative;
  bool isBeforeModel = hasFront && !hasLeft && texelFetch(front, cell, 0).r > 0.0;
  if (isBeforeModel) joinsAfter = max(joinsAfter, frontRestSeconds);
  bool isOdd = !isMover && own.r > kLeastOther;
  if (rest > joinsAfter) {
    isMover = false;
    known.a = 0.0;
    isOdd = !hasLeft;
  }
  past = texelFetch(evidence, cell * reach, 0);  // again: it had no room in registers meanwhile
  if (!isMover) {
    rest = isOdd ? kJoined : past.g < 0.0 && others > 0.08 ? past.g : min(past.g + stepSeconds, 0.0);
  }
  float fresh = isMover != wasMover ? 1.0 : max(past.a - stepSeconds / freshSeconds, 0.0);
  imageStore(labels, cell, vec4(isMover ? 1.0 : 0.0, fresh, rest, maturity));
  // A mover that rests tells nothing of what is behind it, nor does what other content surrounds.
  isLasting = maturity > kMatureSeconds;
  bool isMute = isLasting ? rest > 0.0 : rest < 0.0;
  float activity = known.a >= 0.5 ? activityAt(from) : 0.0;
  float unlike = isStanding ? max(apart(now, known.rgb) - kNoiseMean * noise, 0.0) : 0.0;
  unlike = min(unlike, isLasting ? kMostUnlikeMover : kMostUnlike);
  if (known.a >= 0.5 && !isMute) {
    activity = activityAfter(activity, unlike, stepSeconds,
                             isLasting ? kMoverActivitySeconds : kActivitySeconds);
  }
  imageStore(activityNow, cell, vec4(activity));
  // Beside a mover, some of it may not be labelled.
  bool isBeside = others > 0.08 && hasCause && !isLight;
  if (!isMover && (known.a < 0.5 || !isBeside)) {
    float most = isStanding ? kFrames : kMovingFrames;
    known = withColour(known, now, isLight && own.r > 0.15 ? 1.0 : framesWith(known.a, most));
  }
  imageStore(backgroundNow, cell, known);
}
