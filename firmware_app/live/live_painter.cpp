#include "firmware_app/live/live_painter.h"

#include <cassert>
#include <utility>

namespace pleinair::app {
namespace {

hal::Error notYet() {
  return {.kind = hal::ErrorKind::kTimeout,
          .subject = "GPU",
          .problem = "is still trying to draw into the display's memory",
          .remedy = {}};
}

}  // namespace

LivePainter::LivePainter(const PainterOptions& options, LiveControls& controls,
                         std::shared_ptr<const LiveParameters> start, const MachinePlace& machine)
    : painter_(options),
      controls_(controls),
      seen_(std::move(start)),
      parameters_(seen_->painting),
      camera_(options.scene.camera),
      pictureSize_(options.pictureSize),
      machine_(machine) {
  parameters_.overlay = controls.overlay();
  warmUp(options);
}

void LivePainter::warmUp(const PainterOptions& options) {
  const hal::Image blank(options.expectedFormat.value_or(
      hal::FrameFormat{.pixelFormat = hal::PixelFormat::kGrey8, .size = options.pictureSize}));
  const std::size_t levels = options.qualityLevels ? qualityLevels().size() : 1;
  for (parameters_.quality = 0; parameters_.quality < levels; ++parameters_.quality) {
    if (options.isCancelled && options.isCancelled()) return;
    // An error is reported by the first frame, which has it too.
    static_cast<void>(painter_.paint({.image = blank.view()}, parameters_));
  }
  painter_.reset();
}

hal::Result<void> LivePainter::paint(const hal::CapturedFrame& frame, std::size_t quality) {
  // Those of another style are for the painter that comes after this one.
  if (auto newest = controls_.parameters(); newest != seen_ && newest->style == seen_->style) {
    parameters_ = newest->painting;
    seen_ = std::move(newest);
  }
  parameters_.quality = quality;
  parameters_.overlay = controls_.overlay();
  const bool isSnapshot = controls_.takeSnapshotRequest();
  if (!isSnapshot) {
    const auto painted = painter_.paint(frame, parameters_);
    if (!painted) return tl::unexpected(painted.error());
    giveTags(frame, *painted);
    giveStill(frame, *painted);
    return {};
  }
  // A snapshot shows the finished picture at the best quality, whatever view is painted.
  PaintParameters parameters = parameters_;
  parameters.view.clear();
  parameters.quality = 0;
  const auto painted = painter_.paint(frame, parameters);
  if (!painted) return tl::unexpected(painted.error());
  giveTags(frame, *painted);
  controls_.putSnapshot(painter_.snapshot());
  giveStill(frame, *painted);
  return {};
}

void LivePainter::giveTags(const hal::CapturedFrame& frame, const Picture& picture) {
  controls_.putTags(seenTagsOf(picture.tracking, frame.image.format.size, picture.captureTime));
}

void LivePainter::giveStill(const hal::CapturedFrame& frame, const Picture& picture) {
  if (!controls_.takeStillRequest()) return;
  CameraStill still{.image = painter_.cameraSnapshot(), .place = {}};
  if (const auto machine = cameraFromMachine(machine_, picture.tracking)) {
    const tracking::CameraModel camera =
        camera_ ? *camera_ : scene::assumedCamera(frame.image.format.size);
    still.place = {.camera = scene::fittedCamera(camera, pictureSize_),
                   .cameraFromModel = *machine};
  }
  controls_.putStill(std::move(still));
}

hal::Answer LivePainter::poll(std::size_t output, OutputFrame& frame) {
  return painter_.poll(readbacks_.at(output), frame);
}

runtime::DrawableLayouts LivePainter::drawable() {
  gpu::ImportSupport support = painter_.importSupport();
  return {.modifiers = std::move(support.modifiers),
          .problem = std::move(support.problem),
          .eglDisplay = support.eglDisplay,
          .apartBecause = std::move(support.apartBecause)};
}

hal::Result<void> LivePainter::importLoan(std::size_t output, const runtime::SurfaceLoan& loan) {
  // A software driver that crashes would take the program with it. Those of GPUs refuse. Textures
  // stay within one driver.
  const bool isForeign = loan.surfaces.front().texture.image == nullptr;
  if (painter_.contextInfo().isSoftware && isForeign) {
    if (const auto known = trials_.find(output);
        known != trials_.end() && known->second.loan != loan.number) {
      trials_.erase(known);
    }
    Trial& trial = trials_.try_emplace(output, loan.number, loan.surfaces.front()).first->second;
    const std::optional<hal::Result<void>> result = trial.trial.poll();
    if (!result) return tl::unexpected(notYet());
    if (!*result) return *result;
  }
  return painter_.importSurfaces(readbacks_.at(output), loan.surfaces);
}

void LivePainter::drawNextInto(std::size_t output, const hal::LentSurface& surface) {
  painter_.drawNextInto(readbacks_.at(output), surface);
}

void LivePainter::wait(hal::Duration limit) {
  // The next poll() reports a lost GPU.
  [[maybe_unused]] const auto isReady = painter_.waitForAny(limit);
}

void LivePainter::open(std::size_t output, const hal::OutputFormat& format) {
  assert(output == readbacks_.size());
  readbacks_.push_back(painter_.openReadback(format.frame, format.quarterTurns));
}

void LivePainter::close(std::size_t output) {
  trials_.erase(output);
  painter_.closeReadback(readbacks_.at(output));
}

}  // namespace pleinair::app
