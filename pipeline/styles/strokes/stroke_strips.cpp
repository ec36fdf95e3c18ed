#include "pipeline/styles/strokes/stroke_strips.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pleinair::styles {
namespace {

const std::string kShaders = "pipeline/styles/strokes/shaders/";
constexpr std::size_t kPlanBytes = 8;
constexpr std::size_t kThesisQuads = 36;
/// The size of a storage buffer that every GPU supports (GL ES 3.1, table 20.45).
constexpr std::size_t kMaxBytes = std::size_t{1} << 27U;
/// Px of the full picture that a quad may lie off its stroke: less than is seen.
constexpr float kBendPx = 0.3F;
/// The same for long strokes. Theirs may be a pixel wide, and the width has a part in where they
/// bend: what noise of it changes must be less than is seen.
constexpr float kLongBendPx = 0.075F;

/// Vertices that each slot of short strokes has room for, where quads follow curvature: not all
/// slots hold strokes, and few strokes bend often. stroke_offsets.comp thins out bends where that
/// is too little.
constexpr std::size_t kShortVertices = 8;

std::size_t verticesOf(std::size_t quads) {
  return 2 * quads + 4;
}

/// At most: a quad for each span of the spline but the outer ones.
std::size_t curvatureQuads(StrokeForm form) {
  return form == StrokeForm::kLong ? 15 : 7;
}

gpu::ShaderDefines definesOf(StrokeForm form) {
  return form == StrokeForm::kLong ? gpu::ShaderDefines{{"LONG"}} : gpu::ShaderDefines{};
}

/// The number of vertices for which each slot has room, where quads follow curvature.
std::size_t roomByCurvature(StrokeForm form) {
  return form == StrokeForm::kLong ? verticesOf(curvatureQuads(form)) : kShortVertices;
}

/// The number of quads for which each slot has room, where all have as many.
std::size_t evenQuads(std::size_t slots, StrokeForm form) {
  const std::size_t vertices = kMaxBytes / StrokeStrips::kVertexBytes / slots;
  return std::clamp(std::max<std::size_t>(vertices / 2, 2) - 2, curvatureQuads(form), kThesisQuads);
}

}  // namespace

StrokeStrips StrokeStrips::blank() {
  constexpr std::uint32_t kVertices = 4;
  const std::vector<std::byte> vertices(kVertices * kVertexBytes);
  std::array<std::array<std::uint32_t, 4>, kStripParts> commands{};
  commands.fill({kVertices, 1, 0, 0});
  StrokeStrips strips;
  strips.vertices = gpu::Buffer::of(std::span<const std::byte>(vertices));
  strips.commands = gpu::Buffer::of(std::span<const std::array<std::uint32_t, 4>>(commands));
  return strips;
}

StrokeStripMaker::StrokeStripMaker(const gpu::ShaderLibrary& library, StrokeForm form)
    : form_(form),
      bend_(library.compute(kShaders + "stroke_bend.comp", definesOf(form))),
      offsets_(library.compute(kShaders + "stroke_offsets.comp")),
      lay_(library.compute(kShaders + "stroke_strips.comp", definesOf(form))) {}

void StrokeStripMaker::lay(const gpu::Buffer& instances, const gpu::Buffer& drawn,
                           StrokeQuads quads, StrokeStrips& strips, const StripClipping& clipping) {
  const std::size_t slots = instances.sizeBytes() / instanceBytesOf(form_);
  const glm::ivec2 all(static_cast<int>(slots), 1);
  const bool isEven = quads == StrokeQuads::kThesis;
  const std::size_t even = isEven ? evenQuads(slots, form_) : 0;
  if (!strips.vertices || strips.quads != quads) {
    const std::size_t each = isEven ? verticesOf(even) : roomByCurvature(form_);
    strips.plans = gpu::Buffer(slots * kPlanBytes, gpu::BufferUsage::kDynamic);
    strips.commands = gpu::Buffer(kStripParts * gpu::kDrawCommandBytes, gpu::BufferUsage::kDynamic);
    strips.vertices = {};
    strips.vertices =
        gpu::Buffer(slots * each * StrokeStrips::kVertexBytes, gpu::BufferUsage::kDynamic);
    strips.quads = quads;
  }
  bend_.use()
      .storage("Instances", instances)
      .storage("Drawn", drawn)
      .storage("Plans", strips.plans)
      .set("bend", form_ == StrokeForm::kLong ? kLongBendPx : kBendPx)
      .dispatch(all, GL_SHADER_STORAGE_BARRIER_BIT);
  const bool byMovers = clipping.onlyMovers.has_value();
  offsets_.use()
      .storage("Drawn", drawn)
      .storage("Plans", strips.plans)
      .storage("Commands", strips.commands)
      .storage("BusyBlocks", byMovers ? *clipping.onlyMovers->words : drawn)
      .set("room", static_cast<unsigned>(strips.vertices.sizeBytes() / StrokeStrips::kVertexBytes))
      .set("even", static_cast<unsigned>(even))
      .set("clips", clipping.clips ? 1 : 0)
      .set("byMovers", byMovers ? 1 : 0)
      .set("busyWord", static_cast<unsigned>(marks::BlockCommand::kBusy))
      .dispatch({1, 1}, GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  lay_.use()
      .storage("Instances", instances)
      .storage("Drawn", drawn)
      .storage("Plans", strips.plans)
      .storage("Vertices", strips.vertices)
      .set("even", static_cast<unsigned>(even))
      .dispatch(all, GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT);
}

}  // namespace pleinair::styles
