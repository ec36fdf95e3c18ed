#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// A plain CPU version of the thesis's curly strokes (§4.4, §4.5, §5.4).
namespace pleinair::oracles {

/// The tensor field and the colours under the strokes, by place in px.
struct StrokeGround {
  std::function<glm::dvec2(glm::dvec2)> tensorAt;  ///< (cos 2θ, sin 2θ), θ the gradient's
  std::function<glm::dvec3(glm::dvec2)> colourAt;  ///< sRGB-coded
};

struct StrokeWalk {
  double segmentPx = 8.0;
  int steps = 4;  ///< at most
  double minSteps = 0.0;
  double colourThreshold = 0.1;
  double cutOffRad = 0.8;
  double besidePx = 0.0;  ///< the product's: steps lean away from other colours beside them
};

/// The direction along the edge: the gradient's direction and a quarter turn. A unit vector; its
/// sign has no meaning.
glm::dvec2 strokeDirection(glm::dvec2 tensor);
/// The colour difference that ends strokes: a weighted distance of RGB.
double colourDifference(glm::dvec3 a, glm::dvec3 b);

/// The control points C0 … Cn, as in the thesis: from the anchor one way, one segment per step in
/// the direction at the start of the step, with the sign that bends least, until the colour there
/// differs too much from the start's or two segments differ by more than the cut-off angle.
/// `heading` selects the way.
std::vector<glm::dvec2> thesisSkeleton(const StrokeGround& ground, const StrokeWalk& walk,
                                       glm::dvec2 anchor, glm::dvec2 heading);

/// The product's variant: each step takes the direction half a segment ahead, and the arm ends
/// exactly where the colour differs too much. Gives all of `walk.steps` directions, also beyond the
/// end.
struct StrokeArm {
  std::vector<glm::dvec2> directions;
  double length = 0.0;            ///< of the painted part, in segments
  double nearestToCutOff = 10.0;  ///< rad: the smallest distance of a turn to the cut-off angle
};
StrokeArm strokeArm(const StrokeGround& ground, const StrokeWalk& walk, glm::dvec2 anchor,
                    glm::dvec2 heading);

/// The result of the thesis's average (§5.4) of a past direction with a new one after many short
/// steps, in the doubled angle; `pastShare` is the past's weight after all of them. Unit vectors,
/// whose signs have no meaning.
glm::dvec2 averagedDirection(glm::dvec2 now, glm::dvec2 past, double pastShare);

/// A place on the cubic B-spline with tripled end points, s in [0, n + 2] for points C0 … Cn.
glm::dvec2 splinePlace(const std::vector<glm::dvec2>& points, double s);
/// The thesis's sample points: 4 per segment, 4 (n + 2) + 1 in all.
std::vector<glm::dvec2> thesisSplineSamples(const std::vector<glm::dvec2>& points);

/// The thesis's bump normal (§4.4), in the stroke's tangent frame, from the heights of four texels.
glm::dvec3 bumpNormal(double left, double right, double bottom, double top);
/// Paint lit from the upper left; px, y down.
glm::dvec3 litPaint(glm::dvec3 paint, glm::dvec3 normal, double gloss);

/// The share of a pixel that an object may paint. `its` tells which of the 3 x 3 pixels around, row
/// by row, belong to the object; they are weighted by a tent two pixels wide.
double paintableShare(const std::vector<bool>& its);

}  // namespace pleinair::oracles
