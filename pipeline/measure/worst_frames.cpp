#include "pipeline/measure/worst_frames.h"

#include <algorithm>

#include "pipeline/measure/picture.h"

namespace pleinair::measure {
namespace {

constexpr std::size_t kMost = 3;
constexpr std::uint64_t kApartFrames = 8;
/// Differences are shown so much stronger.
constexpr double kDifferenceGain = 4.0;

}  // namespace

void WorstFrames::offer(std::uint64_t frame, double ew2, const cv::Mat3f& input,
                        const cv::Mat3f& output, const cv::Mat3f& difference) {
  const auto near = std::ranges::find_if(
      frames_, [frame](const WorstFrame& each) { return frame - each.frame < kApartFrames; });
  if (near != frames_.end()) {
    if (near->ew2 >= ew2) return;
    frames_.erase(near);
  } else if (frames_.size() == kMost) {
    if (frames_.back().ew2 >= ew2) return;
    frames_.pop_back();
  }
  cv::Mat3f stronger;
  difference.convertTo(stronger, -1, kDifferenceGain);
  frames_.push_back({.frame = frame,
                     .ew2 = ew2,
                     .input = toImage(input),
                     .output = toImage(output),
                     .difference = toImage(stronger)});
  std::ranges::sort(frames_, std::greater<>(), &WorstFrame::ew2);
}

}  // namespace pleinair::measure
