// What an output stage does where the painter draws into the output's surfaces.
#include <algorithm>
#include <chrono>
#include <optional>
#include <utility>

#include "pipeline/runtime/output/output_stage.h"

namespace pleinair::runtime {
namespace {

/// One on the screen, one flipping, one queued, and two in the painter's hands, beside those of
/// frames that wait until they are due.
constexpr std::size_t kInHand = 5;
constexpr std::size_t kFewest = 6;
constexpr std::size_t kMost = 16;
constexpr hal::Duration kUsualPeriod = std::chrono::milliseconds(33);
constexpr hal::Duration kCopyPatience = std::chrono::milliseconds(100);

std::size_t surfacesFor(hal::Duration latency, std::optional<hal::Duration> framePeriod) {
  const hal::Duration period =
      std::max(framePeriod.value_or(kUsualPeriod), hal::Duration(std::chrono::milliseconds(1)));
  const auto waiting = static_cast<std::size_t>((latency + period - hal::Duration{1}) / period);
  return std::clamp(waiting + kInHand, kFewest, kMost);
}

}  // namespace

std::optional<hal::LentSurface> OutputStage::takeSurface() {
  {
    const std::scoped_lock lock(mutex_);
    // Frames that appear over a picture, or under one, are blended by the processor.
    const bool isWaiting = waiting_ || waitingSurface_ || status_.isWaitingShown || isFading_;
    const bool isBlended = isWaiting || caption_ || brightness_ != kFullBrightness;
    if (isBlended || status_.isFailed || status_.suspension) return std::nullopt;
  }
  return lending_.take();
}

void OutputStage::followLending() {
  hal::GpuSurfaceLender* const lender = output_ ? output_->lender() : nullptr;
  if (lender == nullptr || !options_.drawsDirectly) return;
  {
    const std::scoped_lock lock(mutex_);
    if (status_.isFailed || status_.suspension || request_) return;
  }
  const std::size_t count = surfacesFor(options_.latency, options_.request.framePeriod);
  // A window's thread answers people, too.
  const std::size_t comparisons = output_->surfaces() != nullptr ? count : 1;
  hal::Result<void> stepped = lending_.step(*lender, options_.name, count, comparisons);
  if (stepped) return;
  const std::scoped_lock lock(mutex_);
  fail(std::move(stepped.error()));
}

std::optional<hal::Image> OutputStage::lastFrame() const {
  std::unique_lock lock(mutex_);
  if (!options_.keepsLastFrame) return std::nullopt;
  if (directOnScreen_ && directCopied_ != directShown_) {
    isLastWanted_ = true;
    isWoken_ = true;
    changed_.notify_all();
    lastCopied_.wait_for(lock, kCopyPatience, [this] { return !isLastWanted_; });
  }
  if (lastCopy_) return lastCopy_;
  if (!last_) return std::nullopt;
  return buffers_.at(*last_)->image;
}

/// For lastFrame(), which waits for it.
void OutputStage::copyLastFrame() {
  std::optional<hal::SurfaceId> shown;
  std::uint64_t count = 0;
  {
    const std::scoped_lock lock(mutex_);
    if (!isLastWanted_) return;
    shown = directOnScreen_;
    count = directShown_;
  }
  hal::GpuSurfaceLender* const lender = output_ ? output_->lender() : nullptr;
  std::optional<hal::Image> copy;
  if (shown && lender != nullptr) {
    if (auto seen = lender->copyOfGpuSurface(*shown, false)) copy = *std::move(seen);
  }
  const std::scoped_lock lock(mutex_);
  if (copy) {
    lastCopy_ = std::move(copy);
    directCopied_ = count;
  }
  isLastWanted_ = false;
  lastCopied_.notify_all();
}

void OutputStage::refreshLastFrame() {
  {
    const std::scoped_lock lock(mutex_);
    const bool isCopied = !directOnScreen_ || directCopied_ == directShown_;
    if (!options_.keepsLastFrame || isCopied) return;
    isLastWanted_ = true;
  }
  copyLastFrame();
}

/// For lastFrame(), which nobody would answer after the end.
void OutputStage::keepLastFrame() {
  refreshLastFrame();
  const std::scoped_lock lock(mutex_);
  directOnScreen_.reset();
}

}  // namespace pleinair::runtime
