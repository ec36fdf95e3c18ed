// Purpose: moves the anchors on one virtual model: evaluates each on its triangle at the current
//          pose (thesis §5.3), and hides it where another surface is visible instead.
// Inputs:  surface_point.glsl's, of a camera with the full image's pixels; object, of ids; ids,
//          depth, nearMetres, farMetres (ArFrame), pixelsOfFull, fullSize, margin.
// Outputs: anchors. One invocation per anchor.
// Precision: highp.
#include "pipeline/marks/shaders/anchor.glsl"
#include "pipeline/scene/render/shaders/object_id.glsl"
#include "pipeline/scene/render/shaders/surface_point.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 2) buffer Anchors { Anchor anchors[]; };
uniform highp usampler2D ids;
uniform highp sampler2D depth;
uniform uint object;
uniform float nearMetres;
uniform float farMetres;
uniform vec2 pixelsOfFull;
uniform vec2 fullSize;
uniform float margin;
uniform uint slots;

const float kDepthTolerance = 0.002;  // of the distance, beyond the surface's own slope
const float kMaxSlope = 0.05;

float depthAt(ivec2 pixel) {
  float ndc = 2.0 * texelFetch(depth, pixel, 0).r - 1.0;
  return 2.0 * farMetres * nearMetres / (farMetres + nearMetres - ndc * (farMetres - nearMetres));
}

// Whether the surface visible at px is the anchor's.
bool isSeen(vec2 px, vec3 place, vec3 normal) {
  ivec2 pixel = ivec2(floor(px * pixelsOfFull));
  if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, textureSize(ids, 0)))) return true;
  if (objectOf(texelFetch(ids, pixel, 0).r) != object) return false;
  // The relative change of the surface's distance per pixel.
  float slope = length(normal.xy / (focal * pixelsOfFull)) * place.z / max(abs(dot(normal, place)), 1e-9);
  float tolerance = kDepthTolerance + min(slope, kMaxSlope);
  return abs(depthAt(pixel) - place.z) < tolerance * place.z;
}

void main() {
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= slots) return;
  uint state = anchors[slot].state;
  uint surface = anchors[slot].surface;
  if (!isAlive(state) || objectOf(surface) != object) return;

  uvec4 entry = triangles[body.places.x + numberOf(surface)];
  vec2 part = anchors[slot].barycentrics;
  SurfacePoint point = SurfacePoint(entry.xyz, entry.w, vec3(part, 1.0 - part.x - part.y));
  vec3 place = currentPosition(point);
  if (place.z <= 0.0) {
    anchors[slot].state = 0u;
    return;
  }
  vec3 corners[3];
  for (int i = 0; i < 3; ++i) corners[i] = cameraPosition(point.corners[i]);
  vec3 normal = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
  vec2 px = projected(place);
  vec2 shift = vec2(0.0);
  vec4 jacobian = vec4(1.0, 0.0, 0.0, 1.0);
  uint source = kSourceUnknown;
  if (body.turnsAbout.w != 0.0) {
    vec3 before = previousPosition(point);
    if (before.z > 0.0) {
      shift = px - projected(before);
      source = kSourceSurface;
      // The triangle's affine map from its previous corners to its current ones.
      vec3 was[3];
      for (int i = 0; i < 3; ++i) {
        was[i] = transformed(body.previous, posed[body.places.z + point.corners[i]].position);
      }
      bool isBefore = min(min(was[0].z, was[1].z), was[2].z) > 0.0 &&
                      min(min(corners[0].z, corners[1].z), corners[2].z) > 0.0;
      if (isBefore) {
        vec2 u = projected(was[1]) - projected(was[0]);
        vec2 v = projected(was[2]) - projected(was[0]);
        vec2 a = projected(corners[1]) - projected(corners[0]);
        vec2 b = projected(corners[2]) - projected(corners[0]);
        float area = u.x * v.y - u.y * v.x;
        float longest = max(dot(u, u), dot(v, v));
        // An edge-on triangle gives no direction across it.
        if (abs(area) > 0.02 * longest) {
          jacobian = vec4(a * v.y - b * u.y, b * u.x - a * v.x) / area;
        }
      }
    }
  }
  bool isGone = any(lessThan(px, vec2(-margin))) || any(greaterThan(px, fullSize + margin));
  uint flags = (state & (kAlive | kDying)) | (isSeen(px, place, normal) ? 0u : kHidden);
  anchors[slot].px = px;
  anchors[slot].displacement = shift;
  anchors[slot].jacobian = jacobian;
  anchors[slot].error = source == kSourceSurface ? 0.0 : 1.0e4;
  anchors[slot].state = isGone ? 0u : flags | source;
}
