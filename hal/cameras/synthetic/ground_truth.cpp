#include "hal/cameras/synthetic/ground_truth.h"

#include <limits>
#include <optional>

#include <glm/geometric.hpp>

#include "hal/cameras/synthetic/desk_world.h"
#include "hal/cameras/synthetic/tag_bitmap.h"

namespace pleinair::hal::synthetic {
namespace {

bool isInside(glm::dvec2 pixel, FrameSize size) {
  return pixel.x >= 0 && pixel.y >= 0 && pixel.x < size.width && pixel.y < size.height;
}

glm::dvec2 projected(const CameraView& view, const DeskTag& tag, double edgeMetres, int corner) {
  constexpr double kNowhere = std::numeric_limits<double>::quiet_NaN();
  const glm::dvec3 world(tag.worldFromTag * glm::dvec4(tagCorner(edgeMetres, corner), 1));
  return view.project(world).value_or(glm::dvec2(kNowhere));
}

TagTruth truthOfTag(const CameraView& view, FrameSize size, const DeskTag& tag) {
  TagTruth truth{.tag = tag, .cornersPx = {}, .isInside = true};
  const double borderEdge = tag.edgeMetres * kTagCells / kTagCellsPerEdge;
  for (int corner = 0; corner < 4; ++corner) {
    truth.cornersPx[static_cast<std::size_t>(corner)] =
        projected(view, tag, tag.edgeMetres, corner);
    truth.isInside &= isInside(projected(view, tag, borderEdge, corner), size);
  }
  return truth;
}

}  // namespace

GroundTruth truthOf(const CameraView& view, FrameSize size) {
  GroundTruth truth{
      .intrinsics = view.intrinsics, .cameraFromWorld = view.cameraFromWorld, .tags = {}};
  for (const DeskTag& tag : deskTags()) truth.tags.push_back(truthOfTag(view, size, tag));
  return truth;
}

FlowVector flowBetween(const CameraView& first, const CameraView& second, FrameSize size,
                       glm::dvec2 pixel) {
  constexpr double kSamePointMetres = 1e-6;
  const std::optional<glm::dvec3> surface = surfaceAlong(first.through(pixel));
  if (!surface) return {};
  const std::optional<glm::dvec2> moved = second.project(*surface);
  if (!moved) return {};
  const std::optional<glm::dvec3> seen = surfaceAlong(second.through(*moved));
  const bool isHidden = !seen || glm::distance(*seen, *surface) > kSamePointMetres;
  return {.px = *moved - pixel, .visible = isInside(*moved, size) && !isHidden};
}

FlowField flowFieldBetween(const CameraView& first, const CameraView& second, FrameSize size) {
  FlowField field{.size = size, .px = {}, .visible = {}};
  field.px.reserve(static_cast<std::size_t>(size.pixels()));
  field.visible.reserve(static_cast<std::size_t>(size.pixels()));
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const FlowVector flow = flowBetween(first, second, size, {x + 0.5, y + 0.5});
      field.px.emplace_back(flow.px);
      field.visible.push_back(flow.visible ? 1 : 0);
    }
  }
  return field;
}

}  // namespace pleinair::hal::synthetic
