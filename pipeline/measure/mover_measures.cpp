#include "pipeline/measure/mover_measures.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/picture.h"
#include "pipeline/measure/mean.h"

namespace pleinair::measure {
namespace {

using namespace std::chrono_literals;

constexpr int kContrastLevels = 30;  // a mover's difference from the ground
constexpr int kClearance = 12;       // px around movers that belong to neither
constexpr int kCloseClearance = 3;   // … a mover that leaves has left beyond it
constexpr int kFarClearance = 16;    // … for STILL
constexpr int kWithin = 2;           // px by which movers are eroded for LOST
constexpr int kSmallest = 60;        // px of a mover
constexpr int kStillLevels = 8;
constexpr int kReturnedLevels = 4;
constexpr double kSmooth = 2.0;  // sigma, px
constexpr std::size_t kMedianFrames = 41;
constexpr int kWrongPx = 20;
constexpr double kAveragingSeconds = 0.65;
constexpr hal::Duration kGhost = 200ms;
constexpr hal::Duration kReturn = 1s;

constexpr double kMaxStillPercent = 0.2;
constexpr double kMaxReturnLevels = 4.0;
constexpr double kMaxGhost = 0.25;
constexpr double kMaxLostPercent = 15.0;

cv::Mat3b copyOf(const hal::Image& image) {
  cv::Mat3b copy(image.size().height, image.size().width);
  const hal::ImageView view = image.view();
  for (int y = 0; y < copy.rows; ++y) {
    const auto row = view.row(0, y);
    std::copy_n(row.data(), static_cast<std::size_t>(copy.cols) * 3, copy.ptr<std::uint8_t>(y));
  }
  return copy;
}

/// Of the three channels.
int largestDifference(const cv::Vec3b& a, const cv::Vec3b& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}
double meanDifference(const cv::Vec3b& a, const cv::Vec3b& b) {
  return (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2])) / 3.0;
}

cv::Mat1b differing(const cv::Mat3b& a, const cv::Mat3b& b, int levels) {
  cv::Mat1b mask(a.size());
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      mask(y, x) = largestDifference(a(y, x), b(y, x)) > levels ? 255 : 0;
    }
  }
  return mask;
}

cv::Mat diskOf(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

cv::Mat1b grown(const cv::Mat1b& mask, int radius) {
  cv::Mat1b larger;
  cv::dilate(mask, larger, diskOf(radius));
  return larger;
}

void removeSpecks(cv::Mat1b& mask) {
  cv::Mat1i labels;
  cv::Mat1i stats;
  cv::Mat1d centroids;
  cv::connectedComponentsWithStats(mask, labels, stats, centroids);
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (stats(labels(y, x), cv::CC_STAT_AREA) < kSmallest) mask(y, x) = 0;
    }
  }
}

cv::Mat1b laidWrong(const cv::Mat1b& mask) {
  cv::Mat1b moved(mask.size(), 0);
  const cv::Rect from(0, 0, mask.cols - kWrongPx, mask.rows - kWrongPx);
  mask(from).copyTo(moved(from + cv::Point(kWrongPx, kWrongPx)));
  return moved;
}

double squaredDistance(const cv::Vec3b& a, const cv::Vec3b& b) {
  const cv::Vec3d apart = cv::Vec3d(a) - cv::Vec3d(b);
  return apart.dot(apart);
}

cv::Mat3b smoothed(const cv::Mat3b& picture) {
  cv::Mat3b smooth;
  cv::GaussianBlur(picture, smooth, {}, kSmooth);
  return smooth;
}

/// The visits of movers at one pixel, followed through the sequence.
struct Visit {
  bool hasGround = false;  // of a frame without a mover
  bool isAway = false;     // a mover was here and has left
  bool isGhostTaken = false;
  cv::Vec3b ground{};   // input before
  cv::Vec3b painted{};  // painting before
  hal::TimePoint leftAt;
  Mean contrast;
};

}  // namespace

void MoverMeasures::add(hal::TimePoint time, const hal::Image& input, const hal::Image& output) {
  times_.push_back(time);
  inputs_.push_back(copyOf(input));
  outputs_.push_back(copyOf(output));
}

cv::Mat3b MoverMeasures::ground() const {
  const std::size_t count = std::min(kMedianFrames, inputs_.size());
  std::vector<const cv::Mat3b*> some;
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(&inputs_[i * (inputs_.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
  }
  cv::Mat3b median(inputs_.front().size());
  std::vector<std::uint8_t> values(count);
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  for (int y = 0; y < median.rows; ++y) {
    for (int x = 0; x < median.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < count; ++i) values[i] = (*some[i])(y, x)[c];
        std::nth_element(values.begin(), middle, values.end());
        median(y, x)[c] = *middle;
      }
    }
  }
  return median;
}

std::vector<cv::Mat1b> MoverMeasures::findMovers(const cv::Mat3b& ground) const {
  std::vector<cv::Mat1b> movers;
  for (const cv::Mat3b& input : inputs_) {
    cv::Mat1b mask = differing(input, ground, kContrastLevels);
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, diskOf(1));
    cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, diskOf(3));
    removeSpecks(mask);
    movers.push_back(std::move(mask));
  }
  return movers;
}

std::vector<cv::Mat3b> MoverMeasures::averaged() const {
  std::vector<cv::Mat3b> outputs;
  cv::Mat3f mean;
  inputs_.front().convertTo(mean, CV_32F);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const double step = i == 0 ? 0.0 : hal::toSeconds(times_[i] - times_[i - 1]);
    cv::accumulateWeighted(inputs_[i], mean, 1.0 - std::exp(-step / kAveragingSeconds));
    outputs.emplace_back();
    mean.convertTo(outputs.back(), CV_8U);
  }
  return outputs;
}

MoverSummary MoverMeasures::compare(const std::vector<cv::Mat3b>& outputs,
                                    const std::vector<cv::Mat1b>& movers) const {
  const cv::Size size = inputs_.front().size();
  const cv::Rect inner = innerRect(size);
  std::vector<Visit> visits(static_cast<std::size_t>(size.area()));
  Mean covered;
  Mean still;
  Mean ownChange;
  Mean returned;
  Mean ghost;
  Mean contrast;
  Mean lost;
  cv::Mat3b paintedGround = outputs.front().clone();  // the last painting without a mover
  cv::Mat1b isPaintedGround(size, 0);
  cv::Mat1b farBefore;
  for (std::size_t t = 0; t < inputs_.size(); ++t) {
    const cv::Mat3b& input = inputs_[t];
    const cv::Mat3b& output = outputs[t];
    const cv::Mat1b near = grown(movers[t], kClearance);
    const cv::Mat1b close = grown(movers[t], kCloseClearance);
    const cv::Mat1b far = grown(movers[t], kFarClearance);
    cv::Mat1b within;
    cv::erode(movers[t], within, diskOf(kWithin));
    const cv::Mat3b smooth = smoothed(output);
    const cv::Mat3b smoothInput = smoothed(input);
    const cv::Mat3b smoothGround = smoothed(paintedGround);
    for (int y = inner.y; y < inner.br().y; ++y) {
      for (int x = inner.x; x < inner.br().x; ++x) {
        const cv::Vec3b& seen = input(y, x);
        const cv::Vec3b& painted = output(y, x);
        Visit& visit = visits[static_cast<std::size_t>(y * size.width + x)];
        covered += {movers[t](y, x) != 0 ? 1.0 : 0.0, 1.0};
        if (t > 0 && far(y, x) == 0 && farBefore(y, x) == 0) {
          const int change = largestDifference(painted, outputs[t - 1](y, x));
          const int own = largestDifference(seen, inputs_[t - 1](y, x));
          still += {change > kStillLevels ? 1.0 : 0.0, 1.0};
          ownChange += {own > kStillLevels ? 1.0 : 0.0, 1.0};
        }
        if (close(y, x) != 0) {
          visit.isAway = false;
          if (movers[t](y, x) != 0 && visit.hasGround) {
            visit.contrast += {meanDifference(seen, visit.ground), 1.0};
          }
          const bool isClear = visit.hasGround && within(y, x) != 0 &&
                               largestDifference(seen, visit.ground) > kContrastLevels;
          if (isClear && isPaintedGround(y, x) != 0) {
            const bool isLost = squaredDistance(smooth(y, x), smoothGround(y, x)) <
                                squaredDistance(smooth(y, x), smoothInput(y, x));
            lost += {isLost ? 1.0 : 0.0, 1.0};
          }
          continue;
        }
        if (visit.hasGround && visit.contrast.weight > 0 && !visit.isAway) {
          visit.isAway = true;
          visit.isGhostTaken = false;
          visit.leftAt = times_[t];
        }
        if (visit.isAway) {
          const hal::Duration since = times_[t] - visit.leftAt;
          const bool isSame = largestDifference(seen, visit.ground) <= kReturnedLevels;
          if (!visit.isGhostTaken && since >= kGhost) {
            visit.isGhostTaken = true;
            if (isSame) {
              ghost += {meanDifference(painted, visit.painted), 1.0};
              contrast += {visit.contrast.sum / visit.contrast.weight, 1.0};
            }
          }
          if (since < kReturn || near(y, x) != 0) continue;
          if (isSame) returned += {meanDifference(painted, visit.painted), 1.0};
          visit.isAway = false;
          visit.contrast = {};
        }
        if (near(y, x) != 0) continue;
        visit.hasGround = true;
        visit.ground = seen;
        visit.painted = painted;
        paintedGround(y, x) = painted;
        isPaintedGround(y, x) = 255;
      }
    }
    farBefore = far;
  }
  MoverSummary summary;
  summary.coveredPercent = 100.0 * covered.value().value_or(0);
  if (const auto share = still.value()) {
    summary.stillPercent = 100.0 * std::max(0.0, *share - ownChange.value().value_or(0));
  }
  summary.returnLevels = returned.value();
  summary.ghost = ratio(ghost.value(), contrast.value());
  if (const auto share = lost.value()) summary.lostPercent = 100.0 * *share;
  return summary;
}

std::optional<double> MoverMeasures::displacedStill(const std::vector<cv::Mat1b>& movers) const {
  const cv::Rect inner = innerRect(inputs_.front().size());
  Mean changed;
  cv::Mat1b before;
  for (std::size_t t = 0; t < inputs_.size(); ++t) {
    const cv::Mat1b far = grown(laidWrong(movers[t]), kFarClearance);
    if (t > 0) {
      const cv::Mat1b changes = differing(inputs_[t], inputs_[t - 1], kStillLevels);
      cv::Mat1b away;
      cv::bitwise_or(far, before, away);
      cv::bitwise_not(away, away);
      cv::Mat1b both;
      cv::bitwise_and(changes, away, both);
      changed += {static_cast<double>(cv::countNonZero(both(inner))),
                  static_cast<double>(cv::countNonZero(away(inner)))};
    }
    before = far;
  }
  const std::optional<double> share = changed.value();
  return share ? std::optional(100.0 * *share) : std::nullopt;
}

std::optional<MoverReport> MoverMeasures::total() const {
  if (inputs_.size() < 2) return std::nullopt;
  const std::vector<cv::Mat1b> movers = findMovers(ground());
  return MoverReport{.painting = compare(outputs_, movers),
                     .averaging = compare(averaged(), movers),
                     .displacedStillPercent = displacedStill(movers)};
}

namespace {

Verdict verdictOf(const char* name, const char* unit, std::optional<double> value, double limit,
                  bool isUpperLimit = true) {
  Verdict verdict{.what = fmt::format("{} {} {:g}{}", name, isUpperLimit ? "≤" : ">", limit, unit),
                  .found = "no mover came and went",
                  .comparison = Verdict::Comparison{
                      .value = value, .limit = limit, .isUpperLimit = isUpperLimit}};
  if (!value) return verdict;
  verdict.found = fmt::format("{:.3g}{}", *value, unit);
  const bool isPassed = isUpperLimit ? *value <= limit : *value > limit;
  verdict.state = isPassed ? Verdict::State::kPassed : Verdict::State::kFailed;
  return verdict;
}

}  // namespace

std::vector<Verdict> moverVerdicts(const MoverSummary& movers, bool isOnPaper) {
  std::vector<Verdict> verdicts{
      verdictOf("STILL", " %", movers.stillPercent, kMaxStillPercent),
      verdictOf("RETURN", "", movers.returnLevels, kMaxReturnLevels),
      verdictOf("GHOST", "", movers.ghost, kMaxGhost),
  };
  if (!isOnPaper) {
    verdicts.push_back(verdictOf("LOST", " %", movers.lostPercent, kMaxLostPercent));
  }
  return verdicts;
}

std::vector<Verdict> moverControlVerdicts(const MoverReport& movers) {
  return {
      verdictOf("LOST of a painter that averages over 0.65 s", " %", movers.averaging.lostPercent,
                kMaxLostPercent, false),
      verdictOf("the input's pixels that change, under masks laid wrong by 20 px", " %",
                movers.displacedStillPercent, kMaxStillPercent, false),
  };
}

}  // namespace pleinair::measure
