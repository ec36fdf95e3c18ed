// What an output stage does with waiting pictures.
#include <memory>
#include <optional>
#include <utility>

#include "pipeline/runtime/output_stage.h"

namespace pleinair::runtime {

void OutputStage::showWaiting(std::shared_ptr<const hal::Image> picture, bool fades) {
  const std::scoped_lock lock(mutex_);
  waiting_ = std::move(picture);
  waitingFades_ = fades;
  isWoken_ = true;
  changed_.notify_all();
}

void OutputStage::cancelWaiting() {
  const std::scoped_lock lock(mutex_);
  waiting_.reset();
}

/// Hands the waiting picture over, once no frame is left that would be shown after it.
void OutputStage::presentWaiting() {
  std::shared_ptr<const hal::Image> picture;
  bool fades = false;
  {
    const std::scoped_lock lock(mutex_);
    if (!waiting_ || status_.isFailed || queue_.size() > 0 || !queued_.empty() || waitingSurface_) {
      return;
    }
    picture = waiting_;
    fades = waitingFades_;
  }
  hal::SurfaceOutput* surfaces = output_->surfaces();
  const bool fits = surfaces != nullptr && picture->format() == format_.frame;
  const hal::Answer submitted = fits ? submitWaiting(*surfaces, *picture) : hal::Answer(true);
  if (submitted.hasError() || (fits && submitted.isYes())) fade_.end();
  if (fits && submitted.isYes() && fades) fade_.begin(picture);
  const std::scoped_lock lock(mutex_);
  if (submitted.hasError()) {
    fail(submitted.error());
  } else if (submitted.isYes()) {
    if (waiting_ == picture) waiting_.reset();  // else another one has come meanwhile
    status_.isWaitingShown = status_.isWaitingShown || fits;
  }
}

/// False if no surface is free.
hal::Answer OutputStage::submitWaiting(hal::SurfaceOutput& output, const hal::Image& picture) {
  const hal::Result<std::optional<hal::Surface>> surface = output.acquire();
  if (!surface) return tl::unexpected(surface.error());
  if (!*surface) return false;
  hal::Result<hal::Fence> fence = copyImage(picture.view(), output, **surface);
  if (!fence) {
    output.release(**surface);
    return tl::unexpected(fence.error());
  }
  const auto submitted = output.submit(**surface, *std::move(fence), clock_.now());
  if (!submitted) return tl::unexpected(submitted.error());
  const std::scoped_lock lock(mutex_);
  waitingSurface_ = (*surface)->id;
  return true;
}

std::optional<hal::Image> OutputStage::lastFrame() const {
  const std::scoped_lock lock(mutex_);
  if (!last_) return std::nullopt;
  return buffers_.at(*last_)->image;
}

/// Blends what a waiting picture leaves of itself into a frame.
void OutputStage::fadeIn(const Due& due) {
  isFaded_ = false;
  if (!fade_.isOn()) return;
  isFaded_ = !fade_.apply(buffers_.at(due.frame.buffer)->image, due.frame.due);
}

}  // namespace pleinair::runtime
