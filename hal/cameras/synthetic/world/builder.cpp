#include "hal/cameras/synthetic/world/builder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <glm/ext/matrix_transform.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace pleinair::hal::synthetic {
namespace {

/// Faces turned to the wall or the floor by more than this are hardly ever seen and get coarse
/// textures.
constexpr double kTurnedAway = 0.7;

std::vector<glm::dvec2> ringOutline(double radius, int sides) {
  std::vector<glm::dvec2> ring;
  for (int i = 0; i < sides; ++i) {
    // Starts at the back, so that the front, at −y, is in the middle of the side's canvas.
    const double angle = std::numbers::pi * (0.5 + 2.0 * i / sides);
    ring.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return ring;
}

std::vector<glm::dvec3> lifted(const glm::dmat4& pose, const std::vector<glm::dvec2>& outline,
                               double z) {
  std::vector<glm::dvec3> corners;
  corners.reserve(outline.size());
  for (const glm::dvec2& p : outline) corners.push_back(moved(pose, {p, z}));
  return corners;
}

}  // namespace

glm::dmat4 uprightPose(glm::dvec3 position, double degrees) {
  return glm::rotate(glm::translate(glm::dmat4(1), position), glm::radians(degrees),
                     glm::dvec3(0, 0, 1));
}

std::uint16_t Builder::addPatch(glm::dvec2 half, PatchSurface at, const Painter& painter) {
  assert(plan_.patches.size() < std::numeric_limits<std::uint16_t>::max());
  if (patchSettings_.body != kRoom) {
    at = [inPlace = std::move(at), pose = patchSettings_.litPose](glm::vec2 p) {
      const PointAndNormal own = inPlace(p);
      return PointAndNormal{moved(pose, own.point), glm::dmat3(pose) * own.normal};
    };
  }
  plan_.patches.push_back({glm::vec2(half), std::move(at), painter, patchSettings_.coarseness,
                           patchSettings_.lightStep, patchSettings_.isEmissive,
                           patchSettings_.body});
  return static_cast<std::uint16_t>(plan_.patches.size() - 1);
}

std::uint16_t Builder::addFlatPatch(const Frame& frame, glm::dvec2 half, const Painter& painter) {
  const auto at = [frame](glm::vec2 p) {
    return PointAndNormal{
        frame.centre + frame.right * static_cast<double>(p.x) + frame.up * static_cast<double>(p.y),
        glm::cross(frame.right, frame.up)};
  };
  return addPatch(half, at, painter);
}

void Builder::addFacet(const std::vector<glm::dvec3>& corners, std::uint16_t patch,
                       const Frame& frame) {
  Facet facet;
  facet.normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  facet.offset = glm::dot(facet.normal, corners[0]);
  facet.firstCorner = static_cast<std::uint32_t>(plan_.geometry.corners.size());
  facet.corners = static_cast<std::uint16_t>(corners.size());
  facet.patch = patch;
  facet.u = glm::dvec4(frame.right, -glm::dot(frame.right, frame.centre));
  facet.v = glm::dvec4(frame.up, -glm::dot(frame.up, frame.centre));
  plan_.geometry.facets.push_back(facet);
  plan_.geometry.corners.insert(plan_.geometry.corners.end(), corners.begin(), corners.end());
}

void Builder::addFace(const std::vector<glm::dvec3>& corners, glm::dvec3 right,
                      const Painter& painter) {
  const glm::dvec3 normal =
      glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  Frame frame{{}, glm::normalize(right), {}};
  frame.up = glm::cross(normal, frame.right);
  glm::dvec2 low(std::numeric_limits<double>::infinity());
  glm::dvec2 high = -low;
  for (const glm::dvec3& corner : corners) {
    const glm::dvec2 p(glm::dot(corner, frame.right), glm::dot(corner, frame.up));
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  const glm::dvec2 middle = (low + high) / 2.0;
  frame.centre =
      frame.right * middle.x + frame.up * middle.y + normal * glm::dot(normal, corners[0]);
  const PatchSettings kept = patchSettings_;
  if (patchSettings_.body == kRoom && (normal.y > kTurnedAway || normal.z < -kTurnedAway)) {
    patchSettings_.coarseness *= 4;
    patchSettings_.lightStep *= 4;
  }
  addFacet(corners, addFlatPatch(frame, (high - low) / 2.0, painter), frame);
  patchSettings_ = kept;
}

void Builder::beginSolid() {
  plan_.geometry.solids.push_back(
      {.firstFacet = static_cast<std::uint32_t>(plan_.geometry.facets.size()),
       .body = patchSettings_.body});
}

void Builder::endSolid(const std::optional<Ends>& ends) {
  Geometry& geometry = plan_.geometry;
  Solid& solid = geometry.solids.back();
  solid.facets = static_cast<std::uint32_t>(geometry.facets.size()) - solid.firstFacet;
  const auto facets = std::span(geometry.facets).subspan(solid.firstFacet);
  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  const auto corners = std::span(geometry.corners).subspan(facets.front().firstCorner);
  for (const glm::dvec3& corner : corners) {
    low = glm::min(low, corner);
    high = glm::max(high, corner);
  }
  solid.centre = (low + high) / 2.0;
  for (const glm::dvec3& corner : corners) {
    solid.radius = std::max(solid.radius, glm::distance(corner, solid.centre) * (1 + 1e-9));
  }
  if (!ends || solid.body != kRoom) return;
  Occluder occluder{glm::vec3(solid.centre), static_cast<float>(solid.radius), {}, {}};
  for (const Facet& facet : facets) {
    occluder.planes.emplace_back(glm::vec3(facet.normal), static_cast<float>(facet.offset));
    occluder.patches.push_back(facet.patch);
  }
  // The end planes close the occluder where a cone has none.
  occluder.planes.emplace_back(glm::vec3(ends->axis),
                               static_cast<float>(glm::dot(ends->axis, ends->top)));
  occluder.planes.emplace_back(glm::vec3(-ends->axis),
                               static_cast<float>(-glm::dot(ends->axis, ends->foot)));
  plan_.occluders.push_back(std::move(occluder));
}

Builder::Ends Builder::endsOf(const glm::dmat4& pose, double height) {
  return {glm::dvec3(pose[2]), glm::dvec3(pose[3]), moved(pose, {0, 0, height})};
}

void Builder::prism(const glm::dmat4& pose, const std::vector<glm::dvec2>& outline, double height,
                    const std::vector<Painter>& sides, const Painter& top, const Painter& bottom) {
  assert(outline.size() >= 3 && sides.size() == outline.size());
  beginSolid();
  const std::vector<glm::dvec3> below = lifted(pose, outline, 0);
  const std::vector<glm::dvec3> above = lifted(pose, outline, height);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t next = (i + 1) % outline.size();
    addFace({below[i], below[next], above[next], above[i]}, below[next] - below[i], sides[i]);
  }
  const glm::dvec3 right(pose[0]);
  addFace(above, right, top);
  std::vector<glm::dvec3> fromBelow(below.rbegin(), below.rend());
  if (bottom) addFace(fromBelow, right, bottom);
  endSolid(endsOf(pose, height));
}

void Builder::box(const glm::dmat4& pose, glm::dvec3 size, const BoxFaces& faces) {
  const glm::dvec2 h = glm::dvec2(size) / 2.0;
  const auto face = [&faces](const Painter& painter) { return painter ? painter : faces.other; };
  prism(pose, {{-h.x, -h.y}, {h.x, -h.y}, {h.x, h.y}, {-h.x, h.y}}, size.z,
        {face(faces.front), face(faces.right), face(faces.back), face(faces.left)}, face(faces.top),
        faces.bottom);
}

void Builder::addRoundSide(const glm::dmat4& pose, const Round& round, const Painter& side,
                           bool inwards) {
  constexpr double kPi = std::numbers::pi;
  const double meanRadius = (round.bottomRadius + round.topRadius) / 2;
  const double sign = inwards ? -1 : 1;
  const auto at = [=](glm::vec2 p) {
    const double angle = -kPi / 2 + sign * static_cast<double>(p.x) / meanRadius;
    const double t = 0.5 + static_cast<double>(p.y) / round.height;
    const double radius = round.bottomRadius + t * (round.topRadius - round.bottomRadius);
    const glm::dvec3 out(std::cos(angle), std::sin(angle), 0);
    const glm::dvec3 slanted = glm::normalize(
        glm::dvec3(out.x, out.y, (round.bottomRadius - round.topRadius) / round.height));
    return PointAndNormal{moved(pose, out * radius + glm::dvec3(0, 0, t * round.height)),
                          sign * glm::dvec3(pose * glm::dvec4(slanted, 0))};
  };
  const std::uint16_t patch = addPatch({kPi * meanRadius, round.height / 2}, at, side);
  const auto below = lifted(pose, ringOutline(round.bottomRadius, round.sides), 0);
  const auto above = lifted(pose, ringOutline(round.topRadius, round.sides), round.height);
  const auto count = static_cast<std::size_t>(round.sides);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t next = (i + 1) % count;
    const glm::dvec3 chord = (below[next] + above[next] - below[i] - above[i]) / 2.0;
    const double arc = 2 * kPi * meanRadius / round.sides;
    const double u = sign * (kPi * meanRadius * -1 + arc * (static_cast<double>(i) + 0.5));
    const glm::dvec3 middle = (below[i] + below[next] + above[i] + above[next]) / 4.0;
    Frame frame{middle, sign * chord / glm::length(chord) * (arc / glm::length(chord)), {}};
    const glm::dvec3 rise = (above[i] + above[next] - below[i] - below[next]) / 2.0;
    frame.up = rise * (round.height / glm::dot(rise, rise));
    std::vector<glm::dvec3> corners{below[i], below[next], above[next], above[i]};
    if (inwards) std::ranges::reverse(corners);
    addFacet(corners, patch, frame);
    plan_.geometry.facets.back().u.w += u;
  }
}

namespace {

/// Height on the canvas of each ring of a turned surface: the length of its profile from its
/// middle.
std::vector<double> profileOf(const Builder::Turned& shape) {
  const double radius = (shape.radii.x + shape.radii.y) / 2;
  std::vector<double> heights{0};
  for (std::size_t i = 1; i < shape.rings.size(); ++i) {
    const Builder::Ring& below = shape.rings[i - 1];
    const Builder::Ring& above = shape.rings[i];
    heights.push_back(heights.back() +
                      std::hypot(above.z - below.z, radius * (above.share - below.share)));
  }
  const double half = heights.back() / 2;
  for (double& height : heights) height -= half;
  return heights;
}

double meanRadiusOf(const Builder::Turned& shape) {
  const double share = std::ranges::max(shape.rings, {}, &Builder::Ring::share).share;
  return share * (shape.radii.x + shape.radii.y) / 2;
}

/// The direction out of the profile (outwards, up) at each ring, as of a smooth surface.
std::vector<glm::dvec2> profileNormalsOf(const Builder::Turned& shape) {
  const double radius = (shape.radii.x + shape.radii.y) / 2;
  std::vector<glm::dvec2> normals(shape.rings.size());
  for (std::size_t i = 1; i < shape.rings.size(); ++i) {
    const glm::dvec2 along(radius * (shape.rings[i].share - shape.rings[i - 1].share),
                           shape.rings[i].z - shape.rings[i - 1].z);
    const glm::dvec2 out = glm::normalize(glm::dvec2(along.y, -along.x));
    normals[i - 1] += out;
    normals[i] += out;
  }
  if (shape.rings.front().share == 0) normals.front() = {0, -1};
  if (shape.rings.back().share == 0) normals.back() = {0, 1};
  return normals;
}

}  // namespace

Builder::PatchSurface Builder::turnedSurface(const glm::dmat4& pose, const Turned& shape) {
  return [=, heights = profileOf(shape), normals = profileNormalsOf(shape),
          radius = meanRadiusOf(shape)](glm::vec2 p) {
    const double angle = -std::numbers::pi / 2 + static_cast<double>(p.x) / radius;
    const auto above = std::upper_bound(heights.begin() + 1, heights.end() - 1, p.y);
    const auto i = static_cast<std::size_t>(above - heights.begin());
    const double t = glm::clamp(
        (static_cast<double>(p.y) - heights[i - 1]) / (heights[i] - heights[i - 1]), 0.0, 1.0);
    const glm::dvec2 normal = glm::mix(normals[i - 1], normals[i], t);
    const double z = glm::mix(shape.rings[i - 1].z, shape.rings[i].z, t);
    const double share = glm::mix(shape.rings[i - 1].share, shape.rings[i].share, t);
    const glm::dvec2 out(std::cos(angle), std::sin(angle));
    const double mean = (shape.radii.x + shape.radii.y) / 2;
    const glm::dvec3 facing(normal.x * out / shape.radii, normal.y / mean);
    return PointAndNormal{moved(pose, {share * out * shape.radii, z}),
                          glm::dvec3(pose * glm::dvec4(glm::normalize(facing), 0))};
  };
}

void Builder::turned(const glm::dmat4& pose, const Turned& shape, const Painter& painter) {
  assert(shape.rings.size() >= 2 && shape.sides >= 3);
  beginSolid();
  const std::vector<double> heights = profileOf(shape);
  const double radius = meanRadiusOf(shape);
  const std::uint16_t patch =
      addPatch({std::numbers::pi * radius, heights.back()}, turnedSurface(pose, shape), painter);
  const double arc = 2 * std::numbers::pi * radius / shape.sides;
  const auto sides = static_cast<std::size_t>(shape.sides);
  const auto corner = [&](const Ring& ring, std::size_t side) {
    const double angle =
        std::numbers::pi * (0.5 + 2.0 * static_cast<double>(side % sides) / shape.sides);
    return moved(pose, {ring.share * shape.radii.x * std::cos(angle),
                        ring.share * shape.radii.y * std::sin(angle), ring.z});
  };
  for (std::size_t ring = 1; ring < shape.rings.size(); ++ring) {
    const Ring& below = shape.rings[ring - 1];
    const Ring& above = shape.rings[ring];
    for (std::size_t side = 0; side < sides; ++side) {
      std::vector<glm::dvec3> corners{corner(below, side)};
      if (below.share > 0) corners.push_back(corner(below, side + 1));
      corners.push_back(corner(above, side + 1));
      if (above.share > 0) corners.push_back(corner(above, side));
      const glm::dvec3 chord = (corner(below, side + 1) + corner(above, side + 1) -
                                corner(below, side) - corner(above, side)) /
                               2.0;
      const glm::dvec3 rise = (corner(above, side) + corner(above, side + 1) - corner(below, side) -
                               corner(below, side + 1)) /
                              2.0;
      // The canvas's axes along the facet: across the rise and across the chord, so that
      // neighbouring facets meet at the same heights.
      const glm::dvec3 normal = glm::cross(chord, rise);
      const glm::dvec3 right = glm::cross(rise, normal);
      const glm::dvec3 up = glm::cross(normal, chord);
      const Frame frame{(corner(below, side) + corner(below, side + 1) + corner(above, side) +
                         corner(above, side + 1)) /
                            4.0,
                        right * (arc / glm::dot(right, chord)),
                        up * ((heights[ring] - heights[ring - 1]) / glm::dot(up, rise))};
      addFacet(corners, patch, frame);
      Facet& facet = plan_.geometry.facets.back();
      facet.u.w += arc * (static_cast<double>(side) + 0.5) - std::numbers::pi * radius;
      facet.v.w += (heights[ring] + heights[ring - 1]) / 2;
    }
  }
  endSolid({});
}

void Builder::cylinder(const glm::dmat4& pose, const Round& round, const Painter& side,
                       const Painter& top, const Painter& bottom) {
  beginSolid();
  addRoundSide(pose, round, side, false);
  const glm::dvec3 right(pose[0]);
  if (top) {
    addFace(lifted(pose, ringOutline(round.topRadius, round.sides), round.height), right, top);
  }
  if (bottom) {
    auto corners = lifted(pose, ringOutline(round.bottomRadius, round.sides), 0);
    std::ranges::reverse(corners);
    addFace(corners, right, bottom);
  }
  endSolid(endsOf(pose, round.height));
}

void Builder::hollow(const glm::dmat4& pose, const Round& round, const Painter& side) {
  beginSolid();
  addRoundSide(pose, round, side, true);
  endSolid({});
}

void Builder::rod(glm::dvec3 from, glm::dvec3 to, double fromRadius, double toRadius, int sides,
                  const Painter& side, const Painter& end) {
  const double length = glm::distance(from, to);
  const glm::dvec3 z = (to - from) / length;
  const glm::dvec3 helper = std::abs(z.z) > 0.9 ? glm::dvec3(0, -1, 0) : glm::dvec3(0, 0, -1);
  const glm::dvec3 x = glm::normalize(glm::cross(z, helper));
  const glm::dmat4 pose(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                        glm::dvec4(from, 1));
  const Painter& ends = end ? end : side;
  cylinder(pose, {fromRadius, toRadius, length, sides}, side, ends, ends);
}

void Builder::panel(glm::dvec3 centre, glm::dvec3 right, glm::dvec3 up, glm::dvec2 half,
                    const Painter& painter) {
  beginSolid();
  const glm::dvec3 x = right * half.x;
  const glm::dvec3 y = up * half.y;
  addFace({centre - x - y, centre + x - y, centre + x + y, centre - x + y}, right, painter);
  endSolid({});
}

}  // namespace pleinair::hal::synthetic
