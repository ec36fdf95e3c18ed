// Purpose: the tensors of a region's edge pixels, summed and divided by their strengths (thesis
//          §4.2, step 1), and carried along the motion from frame to frame: those of the background
//          and, by themselves, those of movers. Behind a mover and behind virtual objects
//          (tensor_models.comp), the background's stay as they were. On planes and real things whose
//          poses are known they go with the surface (thesis §6.2), unless the measured motion is
//          surer or contradicts it; its perspective turns them as it does the surface's lines.
// Defines: has_objects.glsl's.
// Inputs:  tensors (gradient.frag), edge_threshold.comp's, pixelsOfFull; regionPixels: a
//          region's side in px of the full image; before, moversBefore: the previous frame's
//          regions, motion (MotionField's), if hasPast; past: the share of them that remains;
//          slack: by which part detail may differ from the held value; rests: the camera stands,
//          and movers are told apart; background_activity.glsl's; image_motion.glsl's, flow
//          backward; edge_parts.glsl's; ids and objectBounds (ArFrame) if
//          hasObjects; surfaceMotion (ArFrame::motion) if hasSurfaces.
// Outputs: regions, moverRegions RGBA16F: as in tensor_region.glsl. One invocation per region.
// Precision: highp.
#include "pipeline/marks/tensors/shaders/edge_bins.glsl"
#include "pipeline/marks/shaders/image_motion.glsl"
#include "pipeline/marks/tensors/shaders/tensor_region.glsl"
#include "pipeline/scene/render/shaders/has_objects.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 0) readonly buffer Edges { EdgeStrengths frameEdges; };
layout(rgba16f, binding = 0) writeonly uniform highp image2D regions;
layout(rgba16f, binding = 1) writeonly uniform highp image2D moverRegions;
uniform highp sampler2D tensors;
uniform highp sampler2D before;
uniform highp sampler2D moversBefore;
uniform highp sampler2D motion;
uniform highp usampler2D ids;
uniform vec4 objectBounds;
uniform highp sampler2D surfaceMotion;
uniform bool hasSurfaces;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform float regionPixels;
uniform bool hasPast;
uniform float past;
uniform float slack;
uniform bool rests;
#include "pipeline/marks/tensors/shaders/edge_parts.glsl"
#include "pipeline/marks/movers/shaders/background_activity.glsl"

const float kLeastSeen = 0.35;  // of a region: less of the background says nothing about it

const float kLeastSurface = 0.5;  // of a region: planes and real things that fill less say nothing
const float kKnownPx = 4.0;  // of error: a motion that is less certain carries no past

// Where the background is dynamic: how many times longer its past remains, and the slack.
const float kDynamicHold = 10.0;
const float kDynamicSlack = 0.5;

const float kReach = 6.0;  // px: half a region, and the width of an edge

// Whether a plane may fill half of a region: what is convex shows in its middle or a corner then.
// Other things are within objectBounds.
bool mayShowSurface(ivec2 low, ivec2 high) {
  if (!hasSurfaces || !hasPast) return false;
  float shown = texelFetch(surfaceMotion, (low + high) / 2, 0).w;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2((i & 1) == 0 ? low.x : high.x - 1, (i & 2) == 0 ? low.y : high.y - 1);
    shown = max(shown, texelFetch(surfaceMotion, corner, 0).w);
  }
  return shown != 0.0;
}

bool isInPicture(vec2 px) {
  return all(greaterThanEqual(px, vec2(0.0))) && all(lessThan(px, fullSize));
}

// The motion of the pixels of a region that show a plane or a real thing, and its moments.
struct Surface {
  vec2 place;
  vec2 displacement;
  vec3 squares;   // of places: xx, yy, xy
  vec4 products;  // of places and displacements: dx · x, dx · y, dy · x, dy · y
  float error;
  float pixels;
};

void add(inout Surface surface, vec2 arm, vec4 moved) {
  vec2 displacement = moved.xy / pixelsOfFull;
  surface.place += arm;
  surface.displacement += displacement;
  surface.squares += vec3(arm * arm, arm.x * arm.y);
  surface.products += vec4(displacement.x * arm, displacement.y * arm);
  surface.error += moved.z / pixelsOfFull.x;
  surface.pixels += 1.0;
}

// Where the region's content was, and how it has been turned and sheared since.
struct Source {
  vec2 from;
  mat2 jacobian;
  bool isKnown;
};

Source sourceOf(Surface surface, vec2 at) {
  vec2 arm = surface.place / surface.pixels;
  vec2 mean = surface.displacement / surface.pixels;
  vec3 squares = surface.squares - surface.pixels * vec3(arm * arm, arm.x * arm.y);
  vec4 products = surface.products - surface.pixels * vec4(mean.x * arm, mean.y * arm);
  float determinant = squares.x * squares.y - squares.z * squares.z;
  Source source = Source(at - mean, mat2(1.0), true);
  // Pixels in a row tell no motion across it.
  if (determinant < 1.0 || determinant < 0.02 * squares.x * squares.y) return source;
  mat2 inverted = mat2(squares.y, -squares.z, -squares.z, squares.x) / determinant;
  // Displacements by places: rows dx, dy.
  vec2 ofX = inverted * products.xy;
  vec2 ofY = inverted * products.zw;
  source.from = at - mean + vec2(dot(ofX, arm), dot(ofY, arm));
  // Columns; the places were the present ones less the displacements.
  mat2 back = mat2(1.0 - ofX.x, -ofY.x, -ofX.y, 1.0 - ofY.y);
  float area = back[0].x * back[1].y - back[1].x * back[0].y;
  if (abs(area) > 0.1) source.jacobian = mat2(back[1].y, -back[0].y, -back[1].x, back[0].x) / area;
  return source;
}

// Whether a surface's motion is to be trusted more than the measured one at `at` (decision 0027):
// each is held against the other, and the surface against flow and what stands still.
// `displacement`: backward; `moved`: of the motion field.
bool isSurer(vec2 displacement, float error, vec4 moved, vec2 at, bool isNearMover) {
  float apart = max(0.0, distance(displacement, -moved.xy) - 2.5 * error);
  Moved surface = Moved(displacement, error, kSourceSurface);
  if (!isNearMover) {
    Moved flowed = byFlow(at);
    float ofFlow = contradicted(surface, flowed.displacement, flowed.error);
    float ofRest = contradicted(surface, vec2(0.0), stillError(at));
    surface.error = length(vec3(error, ofFlow, ofRest));
  }
  return surface.error < kKnownPx && (isNearMover || surface.error <= length(vec2(moved.z, apart)));
}

void main() {
  ivec2 region = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(regions);
  if (any(greaterThanEqual(region, size))) return;
  ivec2 pictureSize = textureSize(tensors, 0);
  ivec2 low = ivec2(floor(vec2(region) * regionPixels * pixelsOfFull));
  ivec2 high = min(ivec2(floor(vec2(region + 1) * regionPixels * pixelsOfFull)), pictureSize);
  vec2 at = (vec2(region) + 0.5) * regionPixels;
  // The largest label around: without any, none is read for the pixels.
  float near = moverAt(at).r;
  for (int i = 0; i < 4; ++i) {
    near = max(near, moverAt(at + kReach * (2.0 * vec2(i & 1, i >> 1) - 1.0)).r);
  }
  float leads = frameEdges.leadingThreshold;
  Edge ground = kNoEdge;
  Edge mover = kNoEdge;
  Surface surface = Surface(vec2(0.0), vec2(0.0), vec3(0.0), vec4(0.0), 0.0, 0.0);
  float hidden = 0.0;  // by virtual objects
  // Two loops in place of a branch, of which software renderers run both sides; of a loop that no
  // invocation enters they run one round.
  bool mayShowObjects = hasObjects && all(lessThan(vec2(low), objectBounds.zw)) &&
                        all(greaterThan(vec2(high), objectBounds.xy));
  bool isPlain = near == 0.0 && !mayShowObjects && !mayShowSurface(low, high);
  for (int y = isPlain ? low.y : high.y; y < high.y; ++y) {
    for (int x = low.x; x < high.x; ++x) {
      add(ground, texelFetch(tensors, ivec2(x, y), 0).xy, 1.0, leads);
    }
  }
  for (int y = isPlain ? high.y : low.y; y < high.y; ++y) {
    for (int x = low.x; x < high.x; ++x) {
      if (hasObjects && isVirtual(objectOf(texelFetch(ids, ivec2(x, y), 0).r))) {
        hidden += 1.0;
        continue;
      }
      if (hasSurfaces && hasPast) {
        vec4 moved = texelFetch(surfaceMotion, ivec2(x, y), 0);
        if (moved.w != 0.0) add(surface, (vec2(x, y) + 0.5) / pixelsOfFull - at, moved);
      }
      vec2 tensor = texelFetch(tensors, ivec2(x, y), 0).xy;
      vec2 parts = near > 0.0 ? edgePartsAt((vec2(x, y) + 0.5) / pixelsOfFull) : vec2(1.0, 0.0);
      add(ground, tensor, parts.x, leads);
      if (parts.y > 0.0) add(mover, tensor, parts.y, leads);
    }
  }
  vec2 extent = vec2(max(high - low, 0));
  float seen = ground.pixels / max(extent.x * extent.y, 1.0);
  hidden /= max(extent.x * extent.y, 1.0);
  // The rest of a region that a model hides in part says less.
  float stays = mix(past, 1.0, smoothstep(0.0, 1.0 - kLeastSeen, hidden));
  vec4 now = regionOf(ground, frameEdges.threshold, pixelsOfFull.x);
  vec4 nowOfMover = vec4(0.0);
  if (mover.pixels > 0.0) nowOfMover = regionOf(mover, frameEdges.threshold, pixelsOfFull.x);
  bool isHeld = seen < kLeastSeen;
  if (hasPast) {
    vec4 moved = textureLod(motion, at / fullSize, 0.0);
    vec2 from = at - moved.xy;
    vec2 texel = 16.0 / fullSize;
    vec2 dx = textureLod(motion, at / fullSize + vec2(texel.x, 0.0), 0.0).xy -
              textureLod(motion, at / fullSize - vec2(texel.x, 0.0), 0.0).xy;
    vec2 dy = textureLod(motion, at / fullSize + vec2(0.0, texel.y), 0.0).xy -
              textureLod(motion, at / fullSize - vec2(0.0, texel.y), 0.0).xy;
    float turn = 0.5 * (dx.y - dy.x) / 32.0;
    bool isKnown = isInPicture(from) && moved.z < kKnownPx;
    vec2 scale = 1.0 / (vec2(size) * regionPixels);
    // Near a mover, the measured motion is not the background's.
    bool isNear = near > 0.0 && known.z != 0.0;
    vec2 behind = isNear ? at + byPicture(at, true).displacement : from;
    float angle = isNear ? 0.0 : turn;
    Source source = Source(behind, mat2(cos(angle), sin(angle), -sin(angle), cos(angle)),
                       isNear ? isInPicture(behind) : isKnown);
    if (rests) source = Source(at, mat2(1.0), true);
    if (surface.pixels > kLeastSurface * extent.x * extent.y) {
      Source onSurface = sourceOf(surface, at);
      if (isSurer(onSurface.from - at, surface.error / surface.pixels, moved, at, isNear)) {
        source = onSurface;
        source.isKnown = isInPicture(source.from);
      }
    }
    if (source.isKnown) {
      vec4 old = textureLod(before, source.from * scale, 0.0);
      old.xy = carriedBy(old.xy, source.jacobian);
      if (isHeld) {
        now = old;
      } else if (old.w > 0.0) {
        float dynamic = rests ? dynamicShare(activityAt(at)) : 0.0;
        float allowed = slack > 0.0 ? max(slack, mix(slack, kDynamicSlack, dynamic)) : 0.0;
        now = held(now, old, pow(stays, 1.0 / mix(1.0, kDynamicHold, dynamic)), allowed);
      }
    } else if (isHeld) {
      now = textureLod(before, at * scale, 0.0);
    }
    if (mover.pixels > 0.0 && isKnown) {
      vec4 oldOfMover = textureLod(moversBefore, from * scale, 0.0);
      oldOfMover.xy = turned(oldOfMover.xy, turn);
      nowOfMover = oldOfMover.w > 0.0 ? held(nowOfMover, oldOfMover, past, slack) : nowOfMover;
    }
  }
  imageStore(regions, region, now);
  imageStore(moverRegions, region, nowOfMover);
}
