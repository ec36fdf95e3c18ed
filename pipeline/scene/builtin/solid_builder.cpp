#include "pipeline/scene/builtin/solid_builder.h"

#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>

#include <glm/geometric.hpp>

#include "pipeline/scene/builtin/shapes.h"

namespace pleinair::scene {
namespace {

double angleAbout(const glm::dvec2& centre, const glm::dvec3& p) {
  return std::atan2(p.y - centre.y, p.x - centre.x);
}

double wrapped(double angleRad) {
  return std::remainder(angleRad, kTurn);
}

MeshVertex vertexOf(const glm::dvec3& position, const glm::dvec3& normal) {
  return {.position = glm::vec3(position), .normal = glm::vec3(normal)};
}

/// Walks a ring once around from `start`; angles are relative to `origin`, rising.
class RingWalk {
 public:
  RingWalk(const Ring& ring, const glm::dvec2& centre, std::size_t start, double origin)
      : ring_(ring), centre_(centre), index_(start), angle_(wrapped(angleAt(start) - origin)) {}

  bool isDone() const { return steps_ == ring_.size(); }
  const glm::dvec3& here() const { return ring_[index_]; }
  const glm::dvec3& next() const { return ring_[following()]; }
  double nextAngle() const { return angle_ + wrapped(angleAt(following()) - angleAt(index_)); }
  void advance() {
    angle_ = nextAngle();
    index_ = following();
    ++steps_;
  }

 private:
  double angleAt(std::size_t i) const { return angleAbout(centre_, ring_[i]); }
  std::size_t following() const { return (index_ + 1) % ring_.size(); }

  const Ring& ring_;
  glm::dvec2 centre_;
  std::size_t index_;
  double angle_;
  std::size_t steps_ = 0;
};

std::size_t nearestInAngle(const Ring& ring, const glm::dvec2& centre, double angleRad) {
  std::size_t best = 0;
  double bestDistance = kTurn;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const double distance = std::abs(wrapped(angleAbout(centre, ring[i]) - angleRad));
    if (distance < bestDistance) {
      best = i;
      bestDistance = distance;
    }
  }
  return best;
}

}  // namespace

Ring circleRing(const glm::dvec2& centre, double radius, double z, std::size_t segments) {
  Ring ring;
  for (std::size_t i = 0; i < segments; ++i) {
    const double angle = kTurn * static_cast<double>(i) / static_cast<double>(segments);
    ring.emplace_back(centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle), z);
  }
  return ring;
}

void SolidBuilder::addTriangle(Side side, const MeshVertex& a, const MeshVertex& b,
                               const MeshVertex& c) {
  const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
  mesh_.vertices.insert(mesh_.vertices.end(), {a, b, c});
  if (side == Side::kUpper) {
    mesh_.triangles.push_back({first, first + 1, first + 2});
  } else {
    mesh_.triangles.push_back({first, first + 2, first + 1});
  }
}

void SolidBuilder::addFlat(Side side, std::span<const glm::dvec3> corners) {
  const glm::dvec3 normal(0.0, 0.0, side == Side::kUpper ? 1.0 : -1.0);
  for (std::size_t i = 2; i < corners.size(); ++i) {
    addTriangle(side, vertexOf(corners[0], normal), vertexOf(corners[i - 1], normal),
                vertexOf(corners[i], normal));
  }
}

void SolidBuilder::addFlatBetween(Side side, const Ring& outer, const Ring& inner,
                                  const glm::dvec2& centre) {
  const double origin = angleAbout(centre, outer.front());
  RingWalk out(outer, centre, 0, origin);
  RingWalk in(inner, centre, nearestInAngle(inner, centre, origin), origin);
  while (!out.isDone() || !in.isDone()) {
    if (in.isDone() || (!out.isDone() && out.nextAngle() <= in.nextAngle())) {
      addFlat(side, std::array{out.here(), out.next(), in.here()});
      out.advance();
    } else {
      addFlat(side, std::array{out.here(), in.next(), in.here()});
      in.advance();
    }
  }
}

void SolidBuilder::addBand(Side side, const Ring& from, const Ring& to,
                           std::span<const glm::dvec3> normals) {
  assert(from.size() == to.size() && normals.size() == 2 * from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    const std::size_t j = (i + 1) % from.size();
    const glm::dvec3& start = normals[2 * i];
    const glm::dvec3& end = normals[2 * i + 1];
    addTriangle(side, vertexOf(from[i], start), vertexOf(from[j], end), vertexOf(to[j], end));
    addTriangle(side, vertexOf(from[i], start), vertexOf(to[j], end), vertexOf(to[i], start));
  }
}

void SolidBuilder::addTurnedBand(Side side, const Ring& from, const Ring& to,
                                 const glm::dvec2& centre) {
  std::vector<glm::dvec3> normals;
  const auto radius = [&](const glm::dvec3& p) { return glm::distance(glm::dvec2(p), centre); };
  // The section runs from `from` to `to` with the solid on its left, or on its right when mirrored.
  const double turn = side == Side::kUpper ? 1.0 : -1.0;
  const glm::dvec2 along(radius(to[0]) - radius(from[0]), to[0].z - from[0].z);
  const glm::dvec2 across = turn * glm::normalize(glm::dvec2(along.y, -along.x));
  for (std::size_t i = 0; i < from.size(); ++i) {
    for (const std::size_t corner : {i, (i + 1) % from.size()}) {
      const glm::dvec2 outward = glm::normalize(glm::dvec2(from[corner]) - centre);
      normals.emplace_back(across.x * outward, across.y);
    }
  }
  addBand(side, from, to, normals);
}

}  // namespace pleinair::scene
