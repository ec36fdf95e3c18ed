#include "pipeline/engine/frame_luma.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "hal/median.h"

namespace pleinair {
namespace {

static_assert(kTrackedSidePx == tracking::LumaFrame::kLongSidePx);

/// Frames in a row that the GPU may be late for.
constexpr int kMostLate = 3;
/// The GPU's way takes at most this part of the copy's time.
constexpr int kGain = 2;

std::string sizeText(hal::FrameSize size) {
  return fmt::format("{}x{} px", size.width, size.height);
}

bool isEqual(const hal::PlaneView& luma, const hal::Image& read) {
  const hal::ImageView other = read.view();
  for (int y = 0; y < other.format.size.height; ++y) {
    const auto row = other.row(0, y);
    const auto own = luma.bytes.subspan(static_cast<std::size_t>(y) * luma.strideBytes, row.size());
    if (!std::ranges::equal(own, row)) return false;
  }
  return true;
}

}  // namespace

FrameLuma::FrameLuma(const gpu::ShaderLibrary& library, const gpu::ContextInfo& context,
                     const gpu::GpuTestHook& testHook, const hal::Clock& clock, LumaLimits limits)
    : clock_(clock), limits_(limits) {
  // As CameraFrames: software renderers import nothing.
  if (!context.isSoftware || testHook.importPlane) readback_.emplace(library, testHook);
}

/// Keeps the text's memory from frame to frame.
void FrameLuma::came(LumaSource source, const std::string& reason) {
  source_ = source;
  if (reason_ != reason) reason_ = reason;
}

void FrameLuma::skip() {
  static const std::string kReason = "nothing tracks";
  came(LumaSource::kNone, kReason);
}

std::optional<hal::FrameMapping> FrameLuma::take(const hal::CapturedFrame& frame,
                                                 gpu::CameraFrames& frames, bool needsWhole) {
  if (frame.luma && !needsWhole) {
    std::optional<hal::FrameMapping> mapped(frame.luma->map());
    const hal::ImageView& image = mapped->view();
    luma_.takeReduced(image.planes[0], image.format.size, frame.image.format.size);
    if (source_ != LumaSource::kSecondStream || streamSize_ != image.format.size) {
      streamSize_ = image.format.size;
      came(LumaSource::kSecondStream, "the camera makes " + sizeText(image.format.size) +
                                          " beside frames of " + sizeText(frame.image.format.size));
    }
    return mapped;
  }
  if (!frame.buffer) {
    static const std::string kReason = "frames lie in the program's memory";
    std::optional<hal::FrameMapping> mapped(frame.image.map());
    luma_.take(mapped->view());
    came(LumaSource::kInPlace, kReason);
    return mapped;
  }
  takeShared(frame, frames);
  return std::nullopt;
}

void FrameLuma::copy(const hal::CapturedFrame& frame) {
  const hal::FrameMapping mapped = frame.image.map();
  luma_.takeCopy(mapped.view());
}

void FrameLuma::takeShared(const hal::CapturedFrame& frame, gpu::CameraFrames& frames) {
  static const std::string kUploaded = "the GPU does not read the camera's memory";
  static const std::string kMosaic = "the GPU reads no luma of mosaics back";
  const hal::FrameFormat& format = frame.image.format;
  if (trial_.pool != frame.buffer.pool || trial_.format != format) {
    trial_ = {.pool = frame.buffer.pool, .format = format};
  }
  const bool isImported = readback_ && !frames.importedPlanes().empty();
  if (!isImported || !gpu::LumaReadback::canRead(format.pixelFormat)) {
    copy(frame);
    const std::string& otherwise = trial_.isOver ? trial_.verdict : kUploaded;
    return came(LumaSource::kCopy, isImported ? kMosaic : otherwise);
  }
  if (!trial_.isOver) return followTrial(frame, frames);
  if (trial_.readsBack && readBack(frame, frames, limits_.frame)) {
    trial_.late = 0;
    const hal::ImageView read = read_.view();
    luma_.take(read.planes[0], format.size);
    return came(LumaSource::kReadback, trial_.verdict);
  }
  copy(frame);
  if (trial_.readsBack && ++trial_.late == kMostLate) refuse("the GPU was late with it");
  came(LumaSource::kCopy, trial_.verdict);
}

/// Reads the frame both ways. The copy is the one that counts.
void FrameLuma::followTrial(const hal::CapturedFrame& frame, gpu::CameraFrames& frames) {
  static const std::string kReason = "a trial of reading it back from the GPU runs";
  const hal::TimePoint begun = clock_.now();
  copy(frame);
  const hal::TimePoint copied = clock_.now();
  const bool isRead = readBack(frame, frames, limits_.trial);
  trial_.copies.at(trial_.rounds) = copied - begun;
  trial_.readbacks.at(trial_.rounds) = clock_.now() - copied;
  ++trial_.rounds;
  if (!isRead) {
    refuse("the GPU was late with it");
  } else if (!isEqual(luma_.luma(), read_)) {
    refuse("the GPU reads other pixels than the processor");
  } else if (trial_.rounds == kRounds) {
    decide();
  }
  came(LumaSource::kCopy, trial_.isOver ? trial_.verdict : kReason);
}

/// Whether it came in time. A lost GPU shows in the frame's next pass.
bool FrameLuma::readBack(const hal::CapturedFrame& frame, gpu::CameraFrames& frames,
                         hal::Duration limit) {
  try {
    readback_->begin(frame.image.format, frames.importedPlanes());
    frames.holdLonger();
    const hal::Answer isRead = readback_->finish(read_, limit);
    return !isRead.hasError() && isRead.isYes();
  } catch (const hal::Failure&) {  // no memory for it
    return false;
  }
}

void FrameLuma::decide() {
  const hal::Duration copies = hal::medianOf(trial_.copies);
  const hal::Duration readbacks = hal::medianOf(trial_.readbacks);
  trial_.isOver = true;
  trial_.readsBack = kGain * readbacks <= copies;
  trial_.verdict = fmt::format("the GPU takes {:.2f} ms, a copy {:.2f} ms",
                               hal::toMilliseconds(readbacks), hal::toMilliseconds(copies));
}

void FrameLuma::refuse(std::string verdict) {
  trial_.isOver = true;
  trial_.readsBack = false;
  trial_.verdict = std::move(verdict);
}

}  // namespace pleinair
