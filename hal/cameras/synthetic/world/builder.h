#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/canvas.h"
#include "hal/cameras/synthetic/world/geometry.h"

namespace pleinair::hal::synthetic {

/// Paints the albedo of a patch: its colours in even white light.
using Painter = std::function<void(Canvas&)>;

struct PointAndNormal {
  glm::dvec3 point{0};
  glm::dvec3 normal{0};
};

/// A surface, flat or rolled up, with its own texture.
struct Patch {
  glm::vec2 half{0};                            ///< of its canvas, metres
  std::function<PointAndNormal(glm::vec2)> at;  ///< the surface point for a point of the canvas
  Painter paint;
  double coarseness = 1;     ///< size of its texels relative to the bench top's
  double lightStep = 0.007;  ///< metres between the points at which light is computed
  bool isEmissive = false;   ///< emissive: the room's light does not change it
  Body body = kRoom;
};

/// A shadow caster: a convex solid, with its inside where dot(xyz, p) ≤ w for all planes.
struct Occluder {
  glm::vec3 centre{0};
  float radius = 0;
  std::vector<glm::vec4> planes;
  std::vector<std::uint16_t> patches;  ///< the patches of its surface
};

/// The description of the world: its shape, and the painters of its surfaces.
struct Plan {
  Geometry geometry;
  std::vector<Patch> patches;
  std::vector<Occluder> occluders;
};

/// The texture and light settings of the patches that follow.
struct PatchSettings {
  double coarseness = 1;
  double lightStep = 0.007;
  bool isEmissive = false;
  Body body = kRoom;
  glm::dmat4 litPose{1};  ///< worldFromBody at which a moving body is lit, once for all
};

/// Adds solids to a plan. A pose maps the solid's own coordinates to its body's.
/// In its own coordinates the solid stands on z = 0, with x to its right and y to its back, seen
/// from its front.
class Builder {
 public:
  Plan& plan() { return plan_; }
  PatchSettings& patchSettings() { return patchSettings_; }

  /// The painters of a box's faces; `other` stands in for each unset one. A box has a bottom only
  /// if `bottom` is set.
  struct BoxFaces {
    Painter other, top, front, right, back, left, bottom;
  };
  void box(const glm::dmat4& pose, glm::dvec3 size, const BoxFaces& faces);
  /// A prism over a convex outline, anticlockwise from above, with one side painter per edge.
  void prism(const glm::dmat4& pose, const std::vector<glm::dvec2>& outline, double height,
             const std::vector<Painter>& sides, const Painter& top, const Painter& bottom = {});
  struct Round {
    double bottomRadius = 0, topRadius = 0, height = 0;
    int sides = 24;
  };
  /// A cylinder or a frustum of a cone; an end without a painter stays open. The side's canvas is
  /// as wide as the circumference, with the front in the middle.
  void cylinder(const glm::dmat4& pose, const Round& round, const Painter& side,
                const Painter& top = {}, const Painter& bottom = {});
  /// A closed surface around the z axis, such as an ellipsoid: rings from its lower end to its
  /// upper. Casts no shadow.
  struct Ring {
    double z = 0;
    double share = 0;  ///< of Turned::radii; 0 only at an end
  };
  struct Turned {
    std::vector<Ring> rings;
    glm::dvec2 radii{1};  ///< along x and y
    int sides = 12;
  };
  /// The canvas is as wide as the mean circumference, with the front in the middle.
  void turned(const glm::dmat4& pose, const Turned& shape, const Painter& painter);
  /// The inner wall of a vessel: a cylinder seen from its axis. Casts no shadow.
  void hollow(const glm::dmat4& pose, const Round& round, const Painter& side);
  /// A cylinder between two points.
  void rod(glm::dvec3 from, glm::dvec3 to, double fromRadius, double toRadius, int sides,
           const Painter& side, const Painter& end = {});
  /// A thin rectangle whose front faces `right` × `up`. Casts no shadow.
  void panel(glm::dvec3 centre, glm::dvec3 right, glm::dvec3 up, glm::dvec2 half,
             const Painter& painter);

 private:
  struct Frame {
    glm::dvec3 centre{0}, right{0}, up{0};
  };
  using PatchSurface = std::function<PointAndNormal(glm::vec2)>;
  std::uint16_t addPatch(glm::dvec2 half, PatchSurface at, const Painter& painter);
  std::uint16_t addFlatPatch(const Frame& frame, glm::dvec2 half, const Painter& painter);
  void addFacet(const std::vector<glm::dvec3>& corners, std::uint16_t patch, const Frame& frame);
  void addFace(const std::vector<glm::dvec3>& corners, glm::dvec3 right, const Painter& painter);
  void addRoundSide(const glm::dmat4& pose, const Round& round, const Painter& side, bool inwards);
  struct Ends {
    glm::dvec3 axis{0}, foot{0}, top{0};
  };
  static Ends endsOf(const glm::dmat4& pose, double height);
  static PatchSurface turnedSurface(const glm::dmat4& pose, const Turned& shape);
  void beginSolid();
  /// Adds an occluder if the ends are known.
  void endSolid(const std::optional<Ends>& ends);

  Plan plan_;
  PatchSettings patchSettings_;
};

/// The pose at `position`, turned anticlockwise about z as seen from above.
glm::dmat4 uprightPose(glm::dvec3 position, double degrees = 0);
/// Where a pose takes a point.
inline glm::dvec3 moved(const glm::dmat4& pose, glm::dvec3 point) {
  return glm::dvec3(pose * glm::dvec4(point, 1));
}

}  // namespace pleinair::hal::synthetic
