#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

/// Curly strokes of the thesis (§4.4, §4.5, §5.4) on the CPU, as plainly as they can be said.
namespace pleinair::oracles {

/// What strokes are grown on, asked at places in px.
struct StrokeGround {
  std::function<glm::dvec2(glm::dvec2)> tensorAt;  ///< (cos 2θ, sin 2θ), θ the gradient's
  std::function<glm::dvec3(glm::dvec2)> colourAt;  ///< sRGB-coded
};

struct StrokeWalk {
  double segmentPx = 8.0;
  int steps = 4;  ///< at most
  double leastSteps = 0.0;
  double colourThreshold = 0.1;
  double cutOffRad = 0.8;
};

/// Along the edge: the gradient's direction and a quarter turn. A unit vector; its sign says
/// nothing.
glm::dvec2 strokeDirection(glm::dvec2 tensor);
/// The colour difference that strokes are stopped by: a weighted distance of RGB.
double colourDifference(glm::dvec3 a, glm::dvec3 b);

/// The control points C0 … Cn as the thesis walks: from the anchor one way, a whole segment a
/// step in the direction where it stands, with the sign that bends least, until the colour there
/// differs too much from the start's or two segments differ by more than the cut-off angle.
/// `heading` says which way.
std::vector<glm::dvec2> thesisSkeleton(const StrokeGround& ground, const StrokeWalk& walk,
                                       glm::dvec2 anchor, glm::dvec2 heading);

/// Ours: each step in the direction half a segment on, and ending at the very place where the
/// colour has changed too much. All of `walk.steps` directions are given, also beyond the end.
struct StrokeArm {
  std::vector<glm::dvec2> directions;
  double length = 0.0;            ///< of what is painted, in segments
  double nearestToCutOff = 10.0;  ///< rad: how near a turn was to deciding otherwise
};
StrokeArm strokeArm(const StrokeGround& ground, const StrokeWalk& walk, glm::dvec2 anchor,
                    glm::dvec2 heading);

/// A place `segments` along an arm's polyline from its anchor.
glm::dvec2 placeOn(const StrokeArm& arm, double segmentPx, glm::dvec2 anchor, double segments);

/// What a past direction has become after many short steps of the thesis's average (§5.4) with a
/// new one, in the doubled angle (thesis §5.4); `pastShare` is what weighs the past after all of
/// them. Unit vectors, whose signs say nothing.
glm::dvec2 averagedDirection(glm::dvec2 now, glm::dvec2 past, double pastShare);

/// A place on the cubic B-spline whose end points are tripled, s in [0, n + 2] for points C0 … Cn.
glm::dvec2 splinePlace(const std::vector<glm::dvec2>& points, double s);
/// The thesis's sample points: 4 a segment, 4 (n + 2) + 1 in all.
std::vector<glm::dvec2> thesisSplineSamples(const std::vector<glm::dvec2>& points);

/// The thesis's bump normal (§4.4), in the stroke's tangent frame, of the four texels' heights.
glm::dvec3 bumpNormal(double left, double right, double bottom, double top);
/// Paint in the painter's light, which comes from the upper left; px, y down.
glm::dvec3 litPaint(glm::dvec3 paint, glm::dvec3 normal, double gloss);

/// How much of a pixel is an object's to paint, of which of the 3 x 3 pixels about it, row by row,
/// are `its`: the tent of two pixels' width over them.
double paintableShare(const std::vector<bool>& its);

}  // namespace pleinair::oracles
