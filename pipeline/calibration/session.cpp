#include "pipeline/calibration/session.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "pipeline/calibration/board_detector.h"

namespace pleinair::calibration {
namespace {

hal::Image greyCopy(const hal::PlaneView& luma, hal::FrameSize size) {
  return hal::Image(hal::ImageView{
      .format = {.pixelFormat = hal::PixelFormat::kGrey8, .size = size}, .planes = {luma}});
}

}  // namespace

CalibrationSession::CalibrationSession(Board board, hal::FrameSize size, SessionOptions options)
    : board_(std::move(board)),
      size_(size),
      options_(options),
      detector_(makeBoardDetector(board_)),
      selector_(board_, size, options.selection) {}

CalibrationSession::~CalibrationSession() = default;

ViewOutcome CalibrationSession::offer(const hal::ImageView& picture, hal::TimePoint time) {
  assert(picture.format.size == size_);
  const hal::PlaneView luma = luma_.convert(picture);
  const std::uint64_t frame = frames_++;
  const ViewOutcome outcome = selector_.offer(frame, time, detector_->detect(luma, size_));
  if (outcome == ViewOutcome::kTaken && options_.keepsPictures) keep(frame, luma);
  if (selector_.counts().withBoard > 0) {
    samples_.clear();
  } else {
    keepSample(frame, luma);
  }
  return outcome;
}

void CalibrationSession::keep(std::uint64_t frame, const hal::PlaneView& luma) {
  pictures_.push_back({frame, greyCopy(luma, size_)});
  std::erase_if(pictures_, [&](const Picture& picture) {
    return std::ranges::find(selector_.views(), picture.frame, &SelectedView::frame) ==
           selector_.views().end();
  });
}

/// Keeps images 0, 1, 3, 7, 15 …: a few from the whole recording.
void CalibrationSession::keepSample(std::uint64_t frame, const hal::PlaneView& luma) {
  const std::uint64_t next = frame + 1;
  constexpr std::size_t kMaxSamples = 6;
  if ((next & frame) != 0) return;
  samples_.push_back(greyCopy(luma, size_));
  if (samples_.size() > kMaxSamples) samples_.erase(samples_.begin());
}

const hal::Image& CalibrationSession::pictureOf(const SelectedView& view) const {
  const auto found = std::ranges::find(pictures_, view.frame, &Picture::frame);
  assert(found != pictures_.end());
  return found->grey;
}

std::optional<std::string> CalibrationSession::otherBoard() const {
  for (const hal::Image& sample : samples_) {
    if (auto other = otherBoardIn(board_, sample.view().planes[0], size_)) return other;
  }
  return std::nullopt;
}

}  // namespace pleinair::calibration
