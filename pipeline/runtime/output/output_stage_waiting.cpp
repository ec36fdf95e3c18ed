// What an output stage does with waiting pictures, and with captions.
#include <memory>
#include <optional>
#include <utility>

#include "pipeline/runtime/output/output_stage.h"

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
  const bool fits = picture->format() == format_.frame;
  hal::Answer submitted(true);
  if (fits && surfaces != nullptr) submitted = submitWaiting(*surfaces, *picture);
  if (fits && surfaces == nullptr) {
    const auto written = output_->memory()->write(picture->view(), {});
    if (!written) submitted = tl::unexpected(written.error());
    const std::scoped_lock lock(mutex_);
    directOnScreen_.reset();
  }
  const bool isTaken = fits && !submitted.hasError() && submitted.isYes();
  if (submitted.hasError() || isTaken) fade_.end();
  if (isTaken && fades) fade_.begin(picture);
  const std::scoped_lock lock(mutex_);
  isFading_ = fade_.isOn();
  if (submitted.hasError()) {
    fail(submitted.error());
  } else if (submitted.isYes()) {
    if (waiting_ == picture) waiting_.reset();  // else another one has come meanwhile
    status_.isWaitingShown = status_.isWaitingShown || fits;
    if (fits) waitingSeen_ = picture;
  }
}

/// False if no surface is free.
hal::Answer OutputStage::submitWaiting(hal::SurfaceOutput& output, const hal::Image& picture) {
  const hal::Result<std::optional<hal::Surface>> surface = output.acquire();
  if (!surface) return tl::unexpected(surface.error());
  if (!*surface) return false;
  hal::Result<hal::Fence> fence = copyWaiting(picture, output, **surface);
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

/// With the caption, and as bright as the display is to be.
hal::Result<hal::Fence> OutputStage::copyWaiting(const hal::Image& picture,
                                                 hal::SurfaceOutput& output,
                                                 const hal::Surface& surface) {
  bool isCaptioned = false;
  Brightness brightness = kFullBrightness;
  {
    const std::scoped_lock lock(mutex_);
    isCaptioned = caption_ != nullptr;
    brightness = brightness_;
  }
  if (!isCaptioned && brightness == kFullBrightness) {
    return copyImage(picture.view(), output, surface);
  }
  hal::Image shown = picture;
  drawCaption(shown);
  if (brightness != kFullBrightness) dim(shown.view(), brightness, shown);
  return copyImage(shown.view(), output, surface);
}

void OutputStage::setCaption(std::shared_ptr<const Caption> caption, double opacity) {
  const std::scoped_lock lock(mutex_);
  if (caption == caption_ && opacity == captionOpacity_) return;
  caption_ = std::move(caption);
  captionOpacity_ = opacity;
  showWaitingAgain();
}

/// With another caption or brightness; frames bring these along by themselves. Precondition: the
/// mutex is held.
void OutputStage::showWaitingAgain() {
  if (!status_.isWaitingShown || !waitingSeen_ || waiting_) return;
  waiting_ = waitingSeen_;
  isWoken_ = true;
  changed_.notify_all();
}

/// Returns what is to be taken off again; null where there is nothing.
std::shared_ptr<const Caption> OutputStage::drawCaption(hal::Image& frame) {
  std::shared_ptr<const Caption> caption;
  double opacity = 0.0;
  {
    const std::scoped_lock lock(mutex_);
    caption = caption_;
    opacity = captionOpacity_;
  }
  if (!caption || !captions_.draw(frame, *caption, opacity)) return nullptr;
  return caption;
}

/// Blends what a waiting picture leaves of itself into a frame.
void OutputStage::fadeIn(const Due& due) {
  isFaded_ = false;
  if (!fade_.isOn()) return;
  OutputFrame& frame = *buffers_.at(due.frame.buffer);
  // It was taken for the GPU before the picture came.
  if (frame.surface) fade_.end();
  isFaded_ = !fade_.apply(frame.image, due.frame.due);
  const std::scoped_lock lock(mutex_);
  isFading_ = fade_.isOn();
}

}  // namespace pleinair::runtime
