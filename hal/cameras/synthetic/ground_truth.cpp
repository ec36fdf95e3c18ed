#include "hal/cameras/synthetic/ground_truth.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace pleinair::hal::synthetic {
namespace {

using Quad = std::array<glm::dvec3, 4>;
using Outline = std::vector<glm::dvec3>;

bool isInside(glm::dvec2 pixel, FrameSize size) {
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.width && pixel.y < size.height;
}

Quad worldCorners(const BenchTag& tag, double edgeMetres) {
  Quad corners;
  for (int corner = 0; corner < 4; ++corner) {
    corners[static_cast<std::size_t>(corner)] =
        glm::dvec3(tag.worldFromTag * glm::dvec4(tagCorner(edgeMetres, corner), 1));
  }
  return corners;
}

/// Clips a convex outline to the half-space normal · p ≤ offset.
Outline clipped(const Outline& outline, glm::dvec3 normal, double offset) {
  Outline kept;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec3& from = outline[i];
    const glm::dvec3& to = outline[(i + 1) % outline.size()];
    const double a = glm::dot(normal, from) - offset;
    const double b = glm::dot(normal, to) - offset;
    if (a <= 0) kept.push_back(from);
    if ((a <= 0) != (b <= 0)) kept.push_back(from + (to - from) * (a / (a - b)));
  }
  return kept;
}

double areaOf(const Outline& outline) {
  glm::dvec3 sum(0);
  for (std::size_t i = 2; i < outline.size(); ++i) {
    sum += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
  }
  return glm::length(sum) / 2;
}

/// Whether any part of a convex outline lies in the pyramid between an eye and a quad in front of
/// it.
bool isBetween(Outline outline, glm::dvec3 eye, const Quad& quad, glm::dvec3 normal) {
  constexpr double kAboveMetres = 1e-4;  // excludes the surface that carries the quad
  constexpr double kMinArea = 1e-10;
  const double side = glm::dot(normal, eye - quad[0]) > 0 ? 1 : -1;
  outline = clipped(outline, -side * normal, -side * glm::dot(normal, quad[0]) - kAboveMetres);
  const glm::dvec3 middle = (quad[0] + quad[2]) / 2.0;
  for (std::size_t i = 0; i < 4 && !outline.empty(); ++i) {
    glm::dvec3 out = glm::normalize(glm::cross(quad[i] - eye, quad[(i + 1) % 4] - eye));
    if (glm::dot(out, middle - eye) > 0) out = -out;
    outline = clipped(outline, out, glm::dot(out, eye));
  }
  return areaOf(outline) > kMinArea;
}

bool isHidden(const Geometry& geometry, const CameraView& view, const BodyPoses& bodies,
              const Quad& quad) {
  const glm::dvec3 eye = view.eye();
  const glm::dvec3 normal = glm::normalize(glm::cross(quad[1] - quad[0], quad[2] - quad[0]));
  for (const Solid& solid : geometry.solids) {
    if (!bodies.has(solid.body)) continue;
    const glm::dmat4& pose = bodies[solid.body];
    for (std::uint32_t i = solid.firstFacet; i < solid.firstFacet + solid.facets; ++i) {
      const Facet& facet = geometry.facets[i];
      Outline outline;
      for (const glm::dvec3& corner : geometry.cornersOf(facet)) {
        outline.emplace_back(pose * glm::dvec4(corner, 1));
      }
      const glm::dvec3 front(pose * glm::dvec4(facet.normal, 0));
      const bool isTurnedAway = glm::dot(front, eye - outline.front()) <= 0;
      if (!isTurnedAway && isBetween(std::move(outline), eye, quad, normal)) return true;
    }
  }
  return false;
}

TagTruth truthOfTag(const Exposure& exposure, const Geometry& geometry, const BenchTag& tag) {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  TagTruth truth{.tag = tag, .cornersPx = {}, .isInside = true, .isVisible = false};
  const Quad corners = worldCorners(tag, tag.edgeMetres);
  const Quad border = worldCorners(tag, tag.edgeMetres * kTagCells / kTagCellsPerEdge);
  truth.isVisible = true;
  for (std::size_t i = 0; i < 4; ++i) {
    truth.cornersPx[i] = exposure.project({corners[i]}).value_or(glm::dvec2(kNowhere));
    const glm::dvec2 at = exposure.project({border[i]}).value_or(glm::dvec2(kNowhere));
    truth.isInside &= isInside(at, exposure.size());
    if (!truth.isInside) continue;
    // With a rolling shutter, each corner has its own time.
    const CameraView view = exposure.viewAt(at.y);
    const bool isTurnedAway = glm::dot(glm::dvec3(tag.worldFromTag[2]),
                                       view.eye() - glm::dvec3(tag.worldFromTag[3])) >= 0;
    truth.isVisible &= !isTurnedAway && !isHidden(geometry, view, exposure.bodiesAt(at.y), border);
  }
  truth.isVisible &= truth.isInside;
  return truth;
}

}  // namespace

GroundTruth truthOf(const Exposure& exposure, const Geometry& geometry) {
  const CameraView middle = exposure.viewAt(static_cast<int>(exposure.size().height / 2) + 0.5);
  GroundTruth truth{
      .intrinsics = middle.intrinsics, .cameraFromWorld = middle.cameraFromWorld, .tags = {}};
  for (const BenchTag& tag : benchTags()) {
    truth.tags.push_back(truthOfTag(exposure, geometry, tag));
  }
  return truth;
}

FlowVector flowBetween(const Exposure& first, const Exposure& second, const Geometry& geometry,
                       glm::dvec2 pixel) {
  constexpr double kSamePointMetres = 1e-6;
  const std::optional<SurfacePoint> surface = first.visibleAt(geometry, pixel);
  if (!surface) return {};
  const std::optional<glm::dvec2> moved = second.project(*surface);
  if (!moved) return {};
  if (!isInside(*moved, second.size())) return {.px = *moved - pixel, .visible = false};
  const std::optional<SurfacePoint> seen = second.visibleAt(geometry, *moved);
  const bool isSame = seen && seen->body == surface->body &&
                      glm::distance(seen->point, surface->point) < kSamePointMetres;
  return {.px = *moved - pixel, .visible = isSame};
}

namespace {

/// The size of a field with a value for every n-th pixel of every n-th row.
FrameSize fieldSize(FrameSize frame, int everyNth) {
  assert(everyNth >= 1);
  return {(frame.width + everyNth - 1) / everyNth, (frame.height + everyNth - 1) / everyNth};
}

}  // namespace

FlowField flowFieldBetween(const Exposure& first, const Exposure& second, const Geometry& geometry,
                           int everyNth) {
  const FrameSize size = fieldSize(first.size(), everyNth);
  FlowField field{.size = size, .px = {}, .visible = {}};
  field.px.reserve(static_cast<std::size_t>(size.pixels()));
  field.visible.reserve(static_cast<std::size_t>(size.pixels()));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const FlowVector flow =
          flowBetween(first, second, geometry, {x * everyNth + 0.5, y * everyNth + 0.5});
      field.px.emplace_back(flow.px);
      field.visible.push_back(flow.visible ? 1 : 0);
    }
  }
  return field;
}

MovingMask movingMaskOf(const Exposure& exposure, const Geometry& geometry, int everyNth) {
  const FrameSize size = fieldSize(exposure.size(), everyNth);
  MovingMask mask{.size = size, .bytes = {}};
  mask.bytes.reserve(static_cast<std::size_t>(size.pixels()));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const std::optional<SurfacePoint> seen =
          exposure.visibleAt(geometry, {x * everyNth + 0.5, y * everyNth + 0.5});
      mask.bytes.push_back(seen && seen->body != kRoom ? 255 : 0);
    }
  }
  return mask;
}

}  // namespace pleinair::hal::synthetic
