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

/// Paints a patch as it would look in even white light.
using Painter = std::function<void(Canvas&)>;

struct PointAndNormal {
  glm::dvec3 point{0};
  glm::dvec3 normal{0};
};

/// A surface, flat or rolled up, with a texture of its own.
struct Patch {
  glm::vec2 half{0};                            ///< its canvas, metres
  std::function<PointAndNormal(glm::vec2)> at;  ///< where a point of the canvas is
  Painter paint;
  double coarseness = 1;     ///< its texels, in those of the bench's top
  double lightStep = 0.007;  ///< metres between points whose light is computed
  bool glows = false;        ///< not lit by what lights the room
  bool moves = false;
};

/// What keeps light out: convex, its inside where dot(xyz, p) ≤ w for all planes.
struct Occluder {
  glm::vec3 centre{0};
  float radius = 0;
  std::vector<glm::vec4> planes;
  std::vector<std::uint16_t> patches;  ///< what it looks like
};

/// The world as a plan: its shape, and how its surfaces are painted.
struct Plan {
  Geometry geometry;
  std::vector<Patch> patches;
  std::vector<Occluder> occluders;
};

/// How the patches that follow are made.
struct Finish {
  double coarseness = 1;
  double lightStep = 0.007;
  bool glows = false;
  bool moves = false;
};

/// Puts solids into a plan. Poses take a solid's own coordinates to the world's (or the mover's):
/// it stands on z = 0, x to its right and y to its back as its front is looked at.
class Builder {
 public:
  Plan& plan() { return plan_; }
  Finish& finish() { return finish_; }

  /// The faces of a box; `other` where one is not set. There is no bottom unless it is set.
  struct BoxFaces {
    Painter other, top, front, right, back, left, bottom;
  };
  void box(const glm::dmat4& pose, glm::dvec3 size, const BoxFaces& faces);
  /// Upright over a convex outline, anticlockwise from above; a side painter for each of its edges.
  void prism(const glm::dmat4& pose, const std::vector<glm::dvec2>& outline, double height,
             const std::vector<Painter>& sides, const Painter& top, const Painter& bottom = {});
  struct Round {
    double bottomRadius = 0, topRadius = 0, height = 0;
    int sides = 24;
  };
  /// A cylinder or a cone's frustum; ends without a painter are left open. The side's canvas is as
  /// wide as it is round, its middle at the front.
  void cylinder(const glm::dmat4& pose, const Round& round, const Painter& side,
                const Painter& top = {}, const Painter& bottom = {});
  /// The inner wall of a vessel: a cylinder that is seen from its axis. Casts no shadow.
  void hollow(const glm::dmat4& pose, const Round& round, const Painter& side);
  /// A cylinder between two points.
  void rod(glm::dvec3 from, glm::dvec3 to, double fromRadius, double toRadius, int sides,
           const Painter& side, const Painter& end = {});
  /// A rectangle without thickness, seen from `right` × `up`. Casts no shadow.
  void panel(glm::dvec3 centre, glm::dvec3 right, glm::dvec3 up, glm::dvec2 half,
             const Painter& painter);

 private:
  struct Frame {
    glm::dvec3 centre{0}, right{0}, up{0};
  };
  std::uint16_t addPatch(glm::dvec2 half, std::function<PointAndNormal(glm::vec2)> at,
                         const Painter& painter);
  std::uint16_t addFlatPatch(const Frame& frame, glm::dvec2 half, const Painter& painter);
  void addFacet(const std::vector<glm::dvec3>& corners, std::uint16_t patch, const Frame& frame);
  void addFace(const std::vector<glm::dvec3>& corners, glm::dvec3 right, const Painter& painter);
  void addRoundSide(const glm::dmat4& pose, const Round& round, const Painter& side, bool inwards);
  struct Ends {
    glm::dvec3 axis{0}, foot{0}, top{0};
  };
  static Ends endsOf(const glm::dmat4& pose, double height);
  void beginSolid();
  /// Casts shadows where its ends are known.
  void endSolid(const std::optional<Ends>& ends);

  Plan plan_;
  Finish finish_;
};

/// A pose: at `position`, turned anticlockwise about z as seen from above.
glm::dmat4 standing(glm::dvec3 position, double degrees = 0);

}  // namespace pleinair::hal::synthetic
