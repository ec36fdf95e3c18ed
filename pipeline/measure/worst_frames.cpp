#include "pipeline/measure/worst_frames.h"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <vector>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

constexpr std::size_t kMaxWorstFrames = 3;
constexpr std::uint64_t kApartFrames = 8;

/// A high percentile of the channels that differ at all.
double brightLevelOf(const cv::Mat3f& difference) {
  constexpr double kShare = 0.97;
  const cv::Mat1f channels = difference.clone().reshape(1, 1);
  std::vector<float> values(channels.begin(), channels.end());
  std::erase(values, 0.0F);
  if (values.empty()) return 0;
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The largest of 1, 2, 5, 10 … that does not saturate the bright differences.
double gainOf(const cv::Mat3f& difference) {
  const double most = 1.0 / std::max(brightLevelOf(difference), 1e-9);
  double gain = 1;
  for (const double step : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
    if (step <= most) gain = step;
  }
  return gain;
}

}  // namespace

void WorstFrames::offer(std::uint64_t frame, double ew2, const cv::Mat3f& input,
                        const cv::Mat3f& output, const cv::Mat3f& difference) {
  const auto near = std::ranges::find_if(
      frames_, [frame](const WorstFrame& each) { return frame - each.frame < kApartFrames; });
  if (near != frames_.end()) {
    if (near->ew2 >= ew2) return;
    frames_.erase(near);
  } else if (frames_.size() == kMaxWorstFrames) {
    if (frames_.back().ew2 >= ew2) return;
    frames_.pop_back();
  }
  const double gain = gainOf(difference);
  cv::Mat3f stronger;
  difference.convertTo(stronger, -1, gain);
  frames_.push_back({.frame = frame,
                     .ew2 = ew2,
                     .input = toImage(input),
                     .output = toImage(output),
                     .difference = toImage(stronger),
                     .differenceGain = gain});
  std::ranges::sort(frames_, std::greater<>(), &WorstFrame::ew2);
}

}  // namespace pleinair::measure
