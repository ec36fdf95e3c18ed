#include "pipeline/scene/builtin/shapes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace pleinair::scene {
namespace {

/// Signs of a square's corners, counter-clockwise.
constexpr std::array<std::pair<int, int>, 4> kSquare{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
constexpr double kRoundCosine = 0.8;  // edges that turn less are smoothed

void addTriangle(Mesh& mesh, const std::array<glm::dvec3, 3>& corners,
                 const std::array<glm::dvec3, 3>& normals) {
  const glm::dvec3 area = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  if (!(glm::length(area) > 1e-15)) return;  // where a section meets the axis
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (std::size_t i = 0; i < 3; ++i) {
    mesh.vertices.push_back(
        {.position = glm::vec3(corners[i]), .normal = glm::vec3(glm::normalize(normals[i]))});
  }
  mesh.triangles.push_back({first, first + 1, first + 2});
}

/// Adds a quad; corners counter-clockwise as seen from outside.
void addQuad(Mesh& mesh, const std::array<glm::dvec3, 4>& corners,
             const std::array<glm::dvec3, 4>& normals) {
  addTriangle(mesh, {corners[0], corners[1], corners[2]}, {normals[0], normals[1], normals[2]});
  addTriangle(mesh, {corners[0], corners[2], corners[3]}, {normals[0], normals[2], normals[3]});
}

/// Adds a flat convex polygon that faces away from `inside`.
void addFace(Mesh& mesh, std::span<const glm::dvec3> corners, const glm::dvec3& inside) {
  glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
  const bool isTurned = glm::dot(normal, corners[0] - inside) < 0.0;
  if (isTurned) normal = -normal;
  for (std::size_t i = 2; i < corners.size(); ++i) {
    const glm::dvec3& b = corners[isTurned ? i : i - 1];
    const glm::dvec3& c = corners[isTurned ? i - 1 : i];
    addTriangle(mesh, {corners[0], b, c}, {normal, normal, normal});
  }
}

/// Outward normals at the start and the end of each edge of a polyline whose solid is on the left.
/// Where two edges meet at a small angle, both normals are averaged.
std::vector<std::array<glm::dvec2, 2>> edgeNormals(std::span<const glm::dvec2> points,
                                                   bool isClosed) {
  const std::size_t edges = isClosed ? points.size() : points.size() - 1;
  std::vector<glm::dvec2> own;
  for (std::size_t i = 0; i < edges; ++i) {
    const glm::dvec2 along = points[(i + 1) % points.size()] - points[i];
    own.push_back(glm::normalize(glm::dvec2(along.y, -along.x)));
  }
  const auto leaning = [&](std::size_t edge, std::size_t neighbour) {
    return glm::dot(own[edge], own[neighbour]) > kRoundCosine
               ? glm::normalize(own[edge] + own[neighbour])
               : own[edge];
  };
  std::vector<std::array<glm::dvec2, 2>> normals;
  for (std::size_t i = 0; i < edges; ++i) {
    const bool hasBefore = isClosed || i > 0;
    const bool hasAfter = isClosed || i + 1 < edges;
    normals.push_back({hasBefore ? leaning(i, (i + edges - 1) % edges) : own[i],
                       hasAfter ? leaning(i, (i + 1) % edges) : own[i]});
  }
  return normals;
}

/// A point or direction (radius, z) at an angle about z.
glm::dvec3 about(const glm::dvec2& p, double angle) {
  return {p.x * std::cos(angle), p.x * std::sin(angle), p.y};
}

}  // namespace

Mesh turned(std::span<const glm::dvec2> section, bool isRing, std::size_t segments,
            TurnRange range) {
  const std::size_t edges = isRing ? section.size() : section.size() - 1;
  const auto normals = edgeNormals(section, isRing);
  Mesh mesh;
  const auto angleAt = [&](std::size_t i) {
    return range.from + (range.to - range.from) * static_cast<double>(i % segments) /
                            static_cast<double>(segments);
  };
  const bool isWhole = range.to - range.from > kTurn - 1e-9;
  for (std::size_t i = 0; i < segments; ++i) {
    const double a = angleAt(i);
    const double b = isWhole || i + 1 < segments ? angleAt(i + 1) : range.to;
    for (std::size_t e = 0; e < edges; ++e) {
      const glm::dvec2& start = section[e];
      const glm::dvec2& end = section[(e + 1) % section.size()];
      addQuad(mesh, {about(start, a), about(start, b), about(end, b), about(end, a)},
              {about(normals[e][0], a), about(normals[e][0], b), about(normals[e][1], b),
               about(normals[e][1], a)});
    }
  }
  if (isWhole || !isRing) return mesh;
  for (const double angle : {range.from, range.to}) {
    std::vector<glm::dvec3> corners;
    for (const glm::dvec2& p : section) corners.push_back(about(p, angle));
    addFace(mesh, corners, about(section[0], 0.5 * (range.from + range.to)));
  }
  return mesh;
}

Mesh prism(std::span<const glm::dvec2> outline, double low, double high) {
  const auto normals = edgeNormals(outline, true);
  Mesh mesh;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec2& a = outline[i];
    const glm::dvec2& b = outline[(i + 1) % outline.size()];
    const glm::dvec3 na(normals[i][0], 0.0);
    const glm::dvec3 nb(normals[i][1], 0.0);
    addQuad(mesh,
            {glm::dvec3(a, low), glm::dvec3(b, low), glm::dvec3(b, high), glm::dvec3(a, high)},
            {na, nb, nb, na});
    const glm::dvec3 up(0.0, 0.0, 1.0);
    addTriangle(mesh, {glm::dvec3(0.0, 0.0, high), glm::dvec3(a, high), glm::dvec3(b, high)},
                {up, up, up});
    addTriangle(mesh, {glm::dvec3(0.0, 0.0, low), glm::dvec3(b, low), glm::dvec3(a, low)},
                {-up, -up, -up});
  }
  return mesh;
}

Mesh bevelledBox(const glm::dvec3& low, const glm::dvec3& high, double bevel) {
  const glm::dvec3 middle = 0.5 * (low + high);
  const glm::dvec3 half = 0.5 * (high - low);
  assert(bevel < std::min({half.x, half.y, half.z}));
  // the corner of the face across `axis` that lies at the box's corner of these signs
  const auto corner = [&](int axis, glm::ivec3 signs) {
    glm::dvec3 offset = half - bevel;
    offset[axis] = half[axis];
    return middle + glm::dvec3(signs) * offset;
  };
  Mesh mesh;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (const int side : {-1, 1}) {
      std::array<glm::dvec3, 4> face{};
      glm::ivec3 signs(side);
      std::size_t i = 0;
      for (const auto& [su, sv] : kSquare) {
        signs[u] = su;
        signs[v] = sv;
        face[i++] = corner(axis, signs);
      }
      addFace(mesh, face, middle);
    }
    if (bevel == 0.0) continue;
    for (const auto& [su, sv] : kSquare) {
      glm::ivec3 start(-1);
      start[u] = su;
      start[v] = sv;
      glm::ivec3 end = start;
      end[axis] = 1;
      addFace(mesh, std::array{corner(u, start), corner(u, end), corner(v, end), corner(v, start)},
              middle);
    }
  }
  if (bevel == 0.0) return mesh;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 signs((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    addFace(mesh, std::array{corner(0, signs), corner(1, signs), corner(2, signs)}, middle);
  }
  return mesh;
}

Mesh sphere(double radius, std::size_t segments, std::size_t rows) {
  std::vector<glm::dvec2> section;
  for (std::size_t i = 0; i <= rows; ++i) {
    const double angle =
        std::numbers::pi * (static_cast<double>(i) / static_cast<double>(rows) - 0.5);
    const bool isPole = i == 0 || i == rows;
    section.emplace_back(isPole ? 0.0 : radius * std::cos(angle), radius * std::sin(angle));
  }
  Mesh mesh = turned(section, false, segments);
  for (MeshVertex& vertex : mesh.vertices) vertex.normal = glm::normalize(vertex.position);
  return mesh;
}

Mesh hexHead(double width, double height) {
  const double corner = 0.5 * width / std::cos(std::numbers::pi / 6.0);
  const double washer = 0.12 * height;
  std::vector<glm::dvec2> hexagon;
  for (int i = 0; i < 6; ++i) {
    const double angle = kTurn * i / 6.0;
    hexagon.emplace_back(corner * std::cos(angle), corner * std::sin(angle));
  }
  const double shoulder = height - 0.2 * height;
  Mesh mesh = prism(hexagon, washer, shoulder);
  // the chamfered top, a little within the hexagon
  const std::array<glm::dvec2, 3> top{
      {{0.49 * width, shoulder}, {0.4 * width, height}, {0.0, height}}};
  append(mesh, turned(top, false, 12));
  const std::array<glm::dvec2, 4> foot{
      {{0.0, 0.0}, {0.62 * width, 0.0}, {0.62 * width, washer}, {0.0, washer}}};
  append(mesh, turned(foot, false, 16));
  return mesh;
}

Mesh notchedWall(const glm::dvec3& low, const glm::dvec3& high, std::span<const Notch> notches) {
  constexpr int kSegments = 24;
  struct EdgePoint {
    double x;
    double z;
  };
  Mesh mesh;
  const auto strip = [&](const EdgePoint& a, const EdgePoint& b, const glm::dvec3& normalA,
                         const glm::dvec3& normalB) {
    const auto front = glm::dvec3(0.0, -1.0, 0.0);
    addQuad(mesh,
            {glm::dvec3(a.x, low.y, low.z), glm::dvec3(b.x, low.y, low.z),
             glm::dvec3(b.x, low.y, b.z), glm::dvec3(a.x, low.y, a.z)},
            {front, front, front, front});
    addQuad(mesh,
            {glm::dvec3(b.x, high.y, low.z), glm::dvec3(a.x, high.y, low.z),
             glm::dvec3(a.x, high.y, a.z), glm::dvec3(b.x, high.y, b.z)},
            {-front, -front, -front, -front});
    addQuad(mesh,
            {glm::dvec3(a.x, low.y, a.z), glm::dvec3(b.x, low.y, b.z), glm::dvec3(b.x, high.y, b.z),
             glm::dvec3(a.x, high.y, a.z)},
            {normalA, normalB, normalB, normalA});
    const auto down = glm::dvec3(0.0, 0.0, -1.0);
    addQuad(mesh,
            {glm::dvec3(a.x, high.y, low.z), glm::dvec3(b.x, high.y, low.z),
             glm::dvec3(b.x, low.y, low.z), glm::dvec3(a.x, low.y, low.z)},
            {down, down, down, down});
  };
  const glm::dvec3 up(0.0, 0.0, 1.0);
  EdgePoint last{low.x, high.z};
  for (const Notch& notch : notches) {
    const EdgePoint first{notch.x - notch.radius, high.z};
    strip(last, first, up, up);
    last = first;
    for (int i = 1; i <= kSegments; ++i) {
      const auto at = [&](int step) {  // from the left over the bottom to the right
        const double angle = std::numbers::pi * (1.0 + static_cast<double>(step) / kSegments);
        return glm::dvec2(std::cos(angle), std::sin(angle));
      };
      const glm::dvec2 a = at(i - 1);
      const glm::dvec2 b = at(i);
      const EdgePoint next{notch.x + notch.radius * b.x,
                           i == kSegments ? high.z : high.z + notch.radius * b.y};
      strip(last, next, {-a.x, 0.0, -a.y}, {-b.x, 0.0, -b.y});
      last = next;
    }
  }
  strip(last, {high.x, high.z}, up, up);
  const glm::dvec3 middle = 0.5 * (low + high);
  for (const double x : {low.x, high.x}) {
    addFace(mesh,
            std::array{glm::dvec3(x, low.y, low.z), glm::dvec3(x, high.y, low.z),
                       glm::dvec3(x, high.y, high.z), glm::dvec3(x, low.y, high.z)},
            middle);
  }
  return mesh;
}

Mesh gusset(double depth, double height, double thickness) {
  const double y = 0.5 * thickness;
  const std::array<glm::dvec2, 3> corners{{{0.0, 0.0}, {depth, 0.0}, {0.0, height}}};
  const glm::dvec3 inside(0.25 * depth, 0.0, 0.25 * height);
  Mesh mesh;
  for (const double side : {-y, y}) {
    std::vector<glm::dvec3> face;
    face.reserve(corners.size());
    for (const glm::dvec2& c : corners) face.emplace_back(c.x, side, c.y);
    addFace(mesh, face, inside);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec2& a = corners[i];
    const glm::dvec2& b = corners[(i + 1) % 3];
    addFace(mesh,
            std::array{glm::dvec3(a.x, -y, a.y), glm::dvec3(b.x, -y, b.y), glm::dvec3(b.x, y, b.y),
                       glm::dvec3(a.x, y, a.y)},
            inside);
  }
  return mesh;
}

void append(Mesh& to, const Mesh& mesh, const glm::dmat4& transform) {
  const auto first = static_cast<std::uint32_t>(to.vertices.size());
  const glm::dmat3 linear(transform);
  const bool isMirror = glm::determinant(linear) < 0.0;
  for (MeshVertex vertex : mesh.vertices) {
    vertex.position = glm::vec3(transform * glm::dvec4(glm::dvec3(vertex.position), 1.0));
    vertex.normal = glm::vec3(glm::normalize(linear * glm::dvec3(vertex.normal)));
    to.vertices.push_back(vertex);
  }
  for (const auto& t : mesh.triangles) {
    to.triangles.push_back(
        {first + t[0], first + t[isMirror ? 2 : 1], first + t[isMirror ? 1 : 2]});
  }
}

}  // namespace pleinair::scene
