#include "pipeline/styles/watercolor/cell_tiling.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <cmath>
#include <span>
#include <string>

#include "pipeline/gpu/images/pixel_block.h"

namespace pleinair::styles {
namespace {

using gpu::ImageAccess;
using gpu::TextureFormat;

/// Makes a pass's writes visible to the next pass, and to the next round, which overwrites them.
constexpr GLbitfield kWritten = GL_SHADER_STORAGE_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                GL_SHADER_IMAGE_ACCESS_BARRIER_BIT;
constexpr int kSettlingRounds = 5;
constexpr std::size_t kSumWords = 9;    // of a cell: cell_sums.glsl
constexpr int kSlotTextureWidth = 256;  // tiling_word.glsl
constexpr float kReachCells = 1.0F;     // of a seed from its anchor
constexpr float kGrowthCells = 1.25F;   // a cell of an anchor without fade has no pixel
constexpr double kPatienceSeconds = 0.25;
const std::string kShaders = "pipeline/styles/watercolor/shaders/";

/// An edge in a cell has the fewer pixels the smaller the picture is.
unsigned minEdgePixels(int ofFull, float pixelsOfFull) {
  return static_cast<unsigned>(
      std::max(1L, std::lround(pixelsOfFull * static_cast<float>(ofFull))));
}

/// The share of its way that something with this time constant goes in `step`.
float shareOf(hal::Duration step, double timeConstantSeconds) {
  const double seconds = std::chrono::duration<double>(step).count();
  return static_cast<float>(1.0 - std::exp(-seconds / timeConstantSeconds));
}

/// The command of glDispatchComputeIndirect: groups along x, y and z.
using Groups = std::array<std::uint32_t, 3>;

/// The groups that cover a picture; none along z, until seeds.comp finds a seed of a mover.
Groups groupsOf(const gpu::Program& program, hal::FrameSize size) {
  const glm::ivec2 groups = program.groupsFor(gpu::pixelBlocksOf(size));
  return {static_cast<std::uint32_t>(groups.x), static_cast<std::uint32_t>(groups.y), 0};
}

gpu::Buffer zeros(std::size_t bytes) {
  const std::vector<std::byte> empty(bytes);
  return gpu::Buffer::of(std::span<const std::byte>(empty), gpu::BufferUsage::kDynamic);
}

}  // namespace

hal::FrameSize slotTextureSize(std::uint32_t slots) {
  const int rows = (static_cast<int>(slots) + kSlotTextureWidth - 1) / kSlotTextureWidth;
  return {kSlotTextureWidth, std::max(1, rows)};
}

CellTiling::CellTiling(const gpu::ShaderLibrary& library)
    : place_(library.compute(kShaders + "seeds.comp")),
      nearest_([&library](const gpu::ShaderDefines& defines) {
        return library.compute(kShaders + "tile.comp", defines);
      }),
      move_(library.compute(kShaders + "cells.comp")),
      bins_(library),
      moverGroups_(zeros(sizeof(Groups))) {}

void CellTiling::allocate(hal::FrameSize full, int cellSizePixels, std::uint32_t slots) {
  assert(slots <= 1U << 22U);  // tiling_word.glsl
  full_ = full;
  cellSize_ = cellSizePixels;
  slots_ = slots;
  const auto binsAlong = [&](int px) {
    return std::max(1, (px + cellSizePixels / 2) / cellSizePixels);
  };
  bins_.allocate({binsAlong(full.width), binsAlong(full.height)}, slots);
  seeds_ = zeros(std::size_t{slots} * sizeof(CellSeed));
  points_ = zeros(std::size_t{slots} * sizeof(marks::BinnedPoint));
  sums_ = zeros(std::size_t{slots} * kSumWords * sizeof(std::uint32_t));
  means_ = gpu::Texture(TextureFormat::kRgba16f, slotTextureSize(slots));
}

void CellTiling::tile(const TilingFrame& input, const marks::AnchorSet& anchors,
                      const WatercolorParameters& p) {
  assert(anchors.slotCount() == slots_ && input.frame->full() == full_);
  placeSeeds(input, anchors, true);
  for (int i = 0; anchors.hasBegunAnew() && i < kSettlingRounds; ++i) {
    findCells(input, p);
    moveSeeds(input, p, true);
    placeSeeds(input, anchors, false);
  }
  findCells(input, p);
  moveSeeds(input, p, false);
}

/// Where the seeds are, and in which bins; they are carried with their anchors if these have moved.
void CellTiling::placeSeeds(const TilingFrame& input, const marks::AnchorSet& anchors,
                            bool carries) {
  const scene::ArFrame& frame = *input.frame;
  const glm::vec2 pixelsOfFull(frame.pixelsOfFull());
  const float growth = kGrowthCells * static_cast<float>(cellSize_) * pixelsOfFull.x;
  const Groups groups = groupsOf(nearest_.use(frame), frame.size());
  moverGroups_.write(std::as_bytes(std::span(groups)));
  place_.use()
      .storage("Anchors", anchors.anchors())
      .storage("Seeds", seeds_)
      .storage("Points", points_)
      .storage("MoverGroups", moverGroups_)
      .texture("tilingThen", input.tilingThen != nullptr ? *input.tilingThen : *input.tiling)
      .set("hasThen", input.tilingThen != nullptr ? 1 : 0)
      .texture("movers", layerTextures_.labelsOf(input.movers))
      .set("hasMovers", input.movers != nullptr ? 1 : 0)
      .set("slots", static_cast<int>(slots_))
      .set("carries", carries ? 1 : 0)
      .set("beginsAnew", anchors.hasBegunAnew() ? 1 : 0)
      .set("full", glm::vec2(full_.width, full_.height))
      .set("pixelsOfFull", pixelsOfFull)
      .set("reach", kReachCells * static_cast<float>(cellSize_))
      .set("growth", growth * growth)
      .dispatch({static_cast<int>(slots_), 1},
                GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  bins_.sort(points_, frame.size());
}

void CellTiling::findCells(const TilingFrame& input, const WatercolorParameters& p) {
  const scene::ArFrame& frame = *input.frame;
  const hal::FrameSize size = frame.size();
  gpu::Program& nearest = nearest_.use(frame);
  nearest.storage("Starts", bins_.starts())
      .storage("Sums", sums_)
      .storage("Sorted", bins_.sorted())
      .storage("MoverGroups", moverGroups_)
      .image("tiling", *input.tiling, ImageAccess::kWrite)
      .texture("picture", *input.picture)
      .texture("ids", frame.hasObjects ? *frame.ids : *input.tiling)
      .texture("movers", layerTextures_.labelsOf(input.movers))
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("bins", bins_.bins())
      .set("binPixels", bins_.binPixels(size))
      .set("alpha", static_cast<float>(p.edgeAlpha))
      .set("beta", static_cast<float>(p.edgeBeta))
      .set("threshold", static_cast<float>(p.edgeThreshold))
      .set("wantsMeans", input.wantsMeans ? 1 : 0)
      .set("ofMovers", 0)
      .dispatch(gpu::pixelBlocksOf(size), kWritten);
  if (input.movers != nullptr) {
    nearest.set("ofMovers", 1)
        .dispatchListed(moverGroups_, 0, nearest.groupsFor(gpu::pixelBlocksOf(size)), kWritten);
  }
}

/// `atOnce`: all the way, whatever the time constants.
void CellTiling::moveSeeds(const TilingFrame& input, const WatercolorParameters& p, bool atOnce) {
  const glm::vec2 pixelsOfFull(input.frame->pixelsOfFull());
  const bool jumps = atOnce || p.retileTimeSeconds <= 0.0;
  const bool stays = p.returnTimeSeconds <= 0.0;
  const float drift = stays ? 0.0F : atOnce ? 1.0F : shareOf(input.step, p.returnTimeSeconds);
  move_.use()
      .storage("Seeds", seeds_)
      .storage("Sums", sums_)
      .storage("Points", points_)
      .image("means", means_, ImageAccess::kWrite)
      .set("slots", static_cast<int>(slots_))
      .set("pixelsOfFull", pixelsOfFull)
      .set("minEdgePixels", minEdgePixels(p.retilePixels, pixelsOfFull.x))
      .set("follow", jumps ? 1.0F : shareOf(input.step, p.retileTimeSeconds))
      .set("drift", drift)
      .set("reach", kReachCells * static_cast<float>(cellSize_))
      .set("rest", static_cast<float>(p.retileRest) * static_cast<float>(cellSize_))
      .set("patience", static_cast<float>(kPatienceSeconds))
      .set("passed", std::chrono::duration<float>(input.step).count())
      .set("atOnce", atOnce ? 1 : 0)
      .set("wantsMeans", input.wantsMeans ? 1 : 0)
      .dispatch({static_cast<int>(slots_), 1}, kWritten);
}

std::size_t CellTiling::readMoving() const {
  std::vector<CellSeed> read(slots_);
  if (!seeds_.read(std::as_writable_bytes(std::span(read)))) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(read, &CellSeed::isMoving));
}

}  // namespace pleinair::styles
