// Which outputs a paint stage paints for, and the surfaces that they lend.
#include <algorithm>
#include <cassert>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/runtime/paint/paint_stage.h"

namespace pleinair::runtime {

void PaintStage::add(OutputStage& output) {
  {
    const std::scoped_lock lock(mutex_);
    toOpen_.push_back(&output);
  }
  wake();
}

void PaintStage::remove(OutputStage& output) {
  {
    const std::scoped_lock lock(mutex_);
    assert(std::ranges::find(toClose_, &output) == toClose_.end());
    toClose_.push_back(&output);
  }
  wake();
}

bool PaintStage::hasReleased(const OutputStage& output) const {
  const std::scoped_lock lock(mutex_);
  return std::ranges::find(toOpen_, &output) == toOpen_.end() &&
         std::ranges::find(toClose_, &output) == toClose_.end();
}

void PaintStage::handleRequests() {
  std::vector<OutputStage*> toOpen;
  std::vector<OutputStage*> toClose;
  {
    const std::scoped_lock lock(mutex_);
    if (toOpen_.empty() && toClose_.empty()) return;
    toOpen = toOpen_;
    toClose = toClose_;
  }
  for (OutputStage* output : toOpen) outputs_.push_back({.stage = output, .format = {}});
  for (OutputStage* output : toClose) close(*output);
  const std::scoped_lock lock(mutex_);
  std::erase_if(toOpen_,
                [&](auto* each) { return std::ranges::find(toOpen, each) != toOpen.end(); });
  std::erase_if(toClose_,
                [&](auto* each) { return std::ranges::find(toClose, each) != toClose.end(); });
  // Under the lock, because once it is free, hasReleased() is true and the output may be destroyed.
  for (OutputStage* output : toClose) output->wake();
}

/// Opens the outputs that are not open in the painter. One that it cannot paint for, and that is
/// opened again by itself, fails, and the others go on. Errors: kDeviceLost; why one is not open
/// that is not opened again, or where no other is open.
hal::Result<void> PaintStage::openOutputs() {
  std::vector<std::pair<const Output*, hal::Error>> refused;
  for (Output& output : outputs_) {
    if (output.isOpen || output.stage->isRefused()) continue;
    output.format = output.stage->format();
    try {
      painter_->open(nextId_, output.format);
    } catch (const hal::Failure& error) {
      const bool isLost = error.error().kind == hal::ErrorKind::kDeviceLost;
      if (isLost || !output.stage->reopens()) return tl::unexpected(error.error());
      refused.emplace_back(&output, error.error());
      continue;
    }
    output.id = nextId_++;
    output.isOpen = true;
    output.taken = inFlight_.size();
    offer(output);
  }
  if (!refused.empty() && countOpen() == 0) return tl::unexpected(refused.front().second);
  for (const auto& [output, error] : refused) output->stage->refuse(output->format, error);
  return {};
}

std::size_t PaintStage::countOpen() const {
  return static_cast<std::size_t>(std::ranges::count_if(outputs_, &Output::isOpen));
}

/// The painter's imports belong to one opening of the output.
void PaintStage::offer(const Output& output) {
  output.stage->lending().offer(painter_->drawable());
  output.stage->wake();
}

/// Draws the pattern into surfaces that were lent.
void PaintStage::followLoans() {
  for (const Output& output : outputs_) {
    if (!painter_) return;
    if (!output.isOpen) continue;
    SurfaceLending& lending = output.stage->lending();
    const std::shared_ptr<const SurfaceLoan> loan = lending.toImport();
    // The loan may belong to a stream that the painter has not been opened for yet.
    if (!loan || loan->surfaces.front().surface.format.size != output.format.frame.size) continue;
    const hal::Result<void> drawn = painter_->importLoan(output.id, *loan);
    if (!drawn && drawn.error().kind == hal::ErrorKind::kTimeout) continue;
    lending.imported(loan->number, drawn);
    output.stage->wake();
    if (!drawn && drawn.error().kind == hal::ErrorKind::kDeviceLost) lose(drawn.error());
  }
}

void PaintStage::takeSurfaces() {
  taken_.clear();
  for (const Output& output : outputs_) {
    if (!output.isOpen) continue;
    if (const auto surface = output.stage->takeSurface()) {
      taken_.emplace_back(output.stage, *surface);
      painter_->drawNextInto(output.id, *surface);
    }
  }
}

/// The frame was not painted.
void PaintStage::giveSurfacesBack() {
  for (const auto& [stage, surface] : taken_) stage->lending().giveBack(surface);
}

/// Ends the frames in flight that an output has not got, and closes it.
void PaintStage::closeInPainter(Output& output) {
  if (!std::exchange(output.isOpen, false)) return;
  for (std::size_t i = output.taken; i < inFlight_.size(); ++i) {
    if (inFlight_[i].ticket) ledger_.end(*inFlight_[i].ticket, Outcome::kStopped);
    --inFlight_[i].pendingOutputs;
  }
  if (painter_) painter_->close(output.id);
}

void PaintStage::close(OutputStage& output) {
  const auto closed = std::ranges::find(outputs_, &output, &Output::stage);
  if (closed == outputs_.end()) return;
  closeInPainter(*closed);
  outputs_.erase(closed);
}

/// Outputs that were opened again may want other pictures than before.
void PaintStage::followFormats() {
  if (!painter_) return;  // the next one is opened with the formats of that time
  for (Output& output : outputs_) {
    if (!haveSameFrames(output.stage->format(), output.format)) closeInPainter(output);
  }
  if (const auto opened = openOutputs(); !opened) lose(opened.error());
}

}  // namespace pleinair::runtime
