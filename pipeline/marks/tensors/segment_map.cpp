#include "pipeline/marks/tensors/segment_map.h"

#include <span>
#include <utility>

namespace pleinair::marks {
namespace {

constexpr std::size_t kTexelBytes = sizeof(std::uint32_t);

/// As shaders/segments.glsl reads it.
std::uint32_t packedOf(const tracking::SegmentCell& cell) {
  return std::uint32_t{cell.label} | (cell.isInside ? 1U << 12U : 0U) |
         std::uint32_t{cell.luma} >> 1U << 13U | std::uint32_t{cell.cb} >> 2U << 20U |
         std::uint32_t{cell.cr} >> 2U << 26U;
}

}  // namespace

void SegmentMap::update(const scene::ArFrame& frame) {
  hasSegments_ = frame.measuredSegments.has_value();
  if (!hasSegments_) return;
  const scene::MeasuredSegments& measured = *frame.measuredSegments;
  const tracking::ImageSegments& segments = *measured.segments;
  packed_.clear();
  for (const tracking::SegmentCell& each : segments.cells) packed_.push_back(packedOf(each));
  if (cells_.size() != segments.grid) cells_ = {gpu::TextureFormat::kR32ui, segments.grid};
  cells_.upload(
      {reinterpret_cast<const std::uint8_t*>(packed_.data()), packed_.size() * kTexelBytes},
      static_cast<std::size_t>(segments.grid.width) * kTexelBytes);
  const glm::dvec2 cellsOfFrame = glm::dvec2(segments.grid.width, segments.grid.height) /
                                  glm::dvec2(segments.frameSize.width, segments.frameSize.height);
  grid_ = glm::vec4(measured.frameScale * cellsOfFrame, measured.frameOrigin * cellsOfFrame);
}

void SegmentMap::bind(gpu::Program& program, const SegmentMap* map, const gpu::Texture& noCells) {
  const bool isThere = map != nullptr && map->hasSegments();
  program.texture("segmentCells", isThere ? map->cells_ : noCells)
      .set("segmentGrid", isThere ? map->grid_ : glm::vec4(0.0F))
      .set("hasSegments", isThere ? 1 : 0);
}

}  // namespace pleinair::marks
