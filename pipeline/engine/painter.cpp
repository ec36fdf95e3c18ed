#include "pipeline/engine/painter.h"

#include <cassert>
#include <utility>

#include "hal/error.h"
#include "pipeline/engine/frame_pipeline.h"
#include "pipeline/engine/quality_levels.h"
#include "pipeline/gpu/handle.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/styles/registry.h"

namespace pleinair {
namespace {

constexpr int kReadbackDepth = 3;  ///< output frames of a read-back in flight

void checkSize(hal::FrameSize size) {
  if (hal::isAcceptedSize(size)) return;
  throw hal::Failure(
      hal::Error{.kind = hal::ErrorKind::kInvalidArgument,
                 .subject = "picture size",
                 .problem = std::to_string(size.width) + "x" + std::to_string(size.height),
                 .remedy = "at least 1 px, at most " + std::to_string(hal::kMaxSidePixels) +
                           " px a side and " + std::to_string(hal::kMaxPixels / 1'000'000) +
                           " Mpx are allowed"});
}

}  // namespace

std::vector<QualityLevel> qualityLevels() {
  std::vector<QualityLevel> levels;
  for (const QualityPlan& plan : qualityPlans()) {
    levels.push_back({std::string(plan.name), std::string(plan.help)});
  }
  return levels;
}

Painter::Painter(const PainterOptions& options) {
  checkSize(options.pictureSize);
  const gpu::CurrentContextKeeper previous;
  PainterGl gl;
  if (options.context == PainterContext::kOwn) {
    gl.own = std::make_unique<gpu::EglContext>(options.windows);
    gl.info = gl.own->info();
  } else {
    gl.info = gpu::inspectCurrentContext("host");
  }
  const ContextScope scope(gl, nullptr);
  pipeline_ = std::make_unique<FramePipeline>(options, std::move(gl));
}

/// The objects of a lost context are abandoned, without calls to its driver.
Painter::~Painter() {
  const ContextScope scope = pipeline_->enter();
  std::optional<gpu::ContextLossGuard> abandon;
  if (pipeline_->resetMonitor_.loss()) abandon.emplace();
  pipeline_.reset();
}

const gpu::ContextInfo& Painter::contextInfo() const {
  return pipeline_->gl_.info;
}

PaintParameters Painter::defaultParameters() const {
  return {.style = pipeline_->defaults_, .view = {}};
}

std::vector<DebugView> Painter::views() const {
  return debugViewsOf(pipeline_->style_->kind().name);
}

hal::Result<Picture> Painter::paint(const hal::CapturedFrame& frame,
                                    const PaintParameters& parameters) {
  const ContextScope scope = pipeline_->enter();
  return pipeline_->paint(frame, parameters);
}

int Painter::openReadback(const hal::FrameFormat& format, int quarterTurns) {
  FramePipeline& p = *pipeline_;
  const ContextScope scope = p.enter();
  hal::orThrow(gpu::checkDeviceLimit(p.gl_.info, present::Readback::packedSize(format),
                                     "picture to be read"));
  hal::orThrow(p.resetMonitor_.check());
  try {
    present::Readback ring(p.library_, format, kReadbackDepth, p.testHook_, quarterTurns);
    for (const FramePipeline::Level& level : p.levels_) ring.warmUp(level.size);
    p.readbacks_.emplace(p.nextReadback_, OpenReadback(std::move(ring), quarterTurns));
    return p.nextReadback_++;
  } catch (const hal::Failure& error) {
    throw hal::Failure(p.orLoss(error.error()));
  }
}

void Painter::closeReadback(int readback) {
  const ContextScope scope = pipeline_->enter();
  std::optional<gpu::ContextLossGuard> abandon;
  if (pipeline_->resetMonitor_.loss()) abandon.emplace();
  [[maybe_unused]] const auto closed = pipeline_->readbacks_.erase(readback);
  assert(closed == 1);
}

gpu::ImportSupport Painter::importSupport() const {
  const ContextScope scope = pipeline_->enter();
  gpu::ImportSupport support = gpu::importSupport(pipeline_->testHook_);
  support.apartBecause = pipeline_->gl_.info.apartBecause;
  return support;
}

hal::Result<void> Painter::importSurfaces(int readback, std::span<const hal::GpuSurface> surfaces) {
  FramePipeline& p = *pipeline_;
  const ContextScope scope = p.enter();
  if (auto valid = p.resetMonitor_.check(); !valid) return valid;
  OpenReadback& open = p.readbacks_.at(readback);
  open.next.reset();
  try {
    if (!open.drawer) {
      open.drawer.emplace(p.library_, open.ring.format().size, open.quarterTurns, p.testHook_);
    }
    std::vector<hal::FrameSize> sizes;
    for (const FramePipeline::Level& level : p.levels_) sizes.push_back(level.size);
    open.drawer->import(surfaces, sizes);
    return {};
  } catch (const hal::Failure& error) {
    return tl::unexpected(p.orLoss(error.error()));
  }
}

void Painter::drawNextInto(int readback, const hal::LentSurface& surface) {
  OpenReadback& open = pipeline_->readbacks_.at(readback);
  assert(open.drawer && open.ring.format().pixelFormat == hal::PixelFormat::kRgba8);
  open.next = surface;
}

hal::Answer Painter::poll(int readback, OutputFrame& frame) {
  const ContextScope scope = pipeline_->enter();
  return pipeline_->copyOldest(readback, frame, &present::Readback::poll, false);
}

hal::Answer Painter::wait(int readback, OutputFrame& frame) {
  const ContextScope scope = pipeline_->enter();
  return pipeline_->copyOldest(readback, frame, &present::Readback::wait, true);
}

hal::Answer Painter::waitForAny(hal::Duration limit) {
  FramePipeline& p = *pipeline_;
  const ContextScope scope = p.enter();
  if (p.resetMonitor_.loss()) return tl::unexpected(*p.resetMonitor_.loss());
  // The GPU works in the order of paintings and, within one, of read-backs.
  const OpenReadback* oldest = nullptr;
  for (const auto& [number, each] : p.readbacks_) {
    if (each.inFlight.empty()) continue;
    const bool isOlder =
        oldest == nullptr || each.inFlight.front().painting < oldest->inFlight.front().painting;
    if (isOlder) oldest = &each;
  }
  if (oldest == nullptr) return false;
  hal::Answer isReady = oldest->isReadyWithin(limit);
  if (isReady.hasError()) return tl::unexpected(p.orLoss(isReady.error()));
  return isReady;
}

bool Painter::hasRoom(int readback) const {
  return pipeline_->readbacks_.at(readback).ring.hasRoom();
}

std::uint64_t Painter::skipped(int readback) const {
  return pipeline_->readbacks_.at(readback).skipped;
}

hal::Result<hal::Image> Painter::snapshot() const {
  const ContextScope scope = pipeline_->enter();
  return pipeline_->read(pipeline_->picture_);
}

hal::Result<hal::Image> Painter::cameraSnapshot() const {
  const ContextScope scope = pipeline_->enter();
  return pipeline_->read(pipeline_->camera_);
}

hal::Result<hal::Image> Painter::composedSnapshot() const {
  const ContextScope scope = pipeline_->enter();
  return pipeline_->read(pipeline_->composed_);
}

hal::Result<scene::SurfaceSnapshot> Painter::surfaces() const {
  FramePipeline& p = *pipeline_;
  assert(p.readsSurfaces_);
  const ContextScope scope = p.enter();
  if (auto valid = p.resetMonitor_.check(); !valid) return tl::unexpected(std::move(valid.error()));
  try {
    scene::SurfaceSnapshot surfaces = p.renderer_.snapshot();
    if (auto valid = p.resetMonitor_.check(); !valid) {
      return tl::unexpected(std::move(valid.error()));
    }
    return surfaces;
  } catch (const hal::Failure& error) {
    return tl::unexpected(p.orLoss(error.error()));
  }
}

hal::Result<std::vector<marks::Anchor>> Painter::anchors() const {
  FramePipeline& p = *pipeline_;
  const ContextScope scope = p.enter();
  if (auto valid = p.resetMonitor_.check(); !valid) return tl::unexpected(std::move(valid.error()));
  std::vector<marks::Anchor> anchors = p.style_->readAnchors();
  if (auto valid = p.resetMonitor_.check(); !valid) return tl::unexpected(std::move(valid.error()));
  return anchors;
}

std::span<const overlay::PlacedLabel> Painter::overlayLabels() const {
  if (!pipeline_->overlay_) return {};
  return pipeline_->overlay_->labels();
}

hal::Result<std::optional<hal::Image>> Painter::movers() const {
  FramePipeline& p = *pipeline_;
  const ContextScope scope = p.enter();
  if (auto valid = p.resetMonitor_.check(); !valid) return tl::unexpected(std::move(valid.error()));
  const marks::MotionLayers* const layers = p.style_->movers();
  if (layers == nullptr) return std::nullopt;
  try {
    std::optional<hal::Image> movers = layers->readMovers();
    if (auto valid = p.resetMonitor_.check(); !valid) {
      return tl::unexpected(std::move(valid.error()));
    }
    return movers;
  } catch (const hal::Failure& error) {
    return tl::unexpected(p.orLoss(error.error()));
  }
}

const CameraPath& Painter::cameraPath() const {
  FramePipeline& p = *pipeline_;
  p.cameraPath_.frames = p.frames_.status();
  p.cameraPath_.luma = p.luma_.source();
  p.cameraPath_.lumaReason = p.luma_.reason();
  return p.cameraPath_;
}

void Painter::reset() {
  FramePipeline& p = *pipeline_;
  const ContextScope scope = p.enter();
  p.forgetPast();
  p.imageMotion_.reset();
}

std::span<const gpu::PassTime> Painter::passTimes() const {
  return pipeline_->timer_.times();
}

}  // namespace pleinair
