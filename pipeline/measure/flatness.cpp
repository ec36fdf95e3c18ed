#include "pipeline/measure/flatness.h"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "hal/median.h"
#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

/// Frames at each end over which textures are averaged.
constexpr std::size_t kEnds = 5;
constexpr std::size_t kSpectrumSteps = 64;

using Cooccurrence = cv::Matx<double, TextureStatistics::kLevels, TextureStatistics::kLevels>;

cv::Mat1i levelsOf(const cv::Mat1f& grey) {
  cv::Mat1i levels(grey.size());
  for (int y = 0; y < grey.rows; ++y) {
    for (int x = 0; x < grey.cols; ++x) {
      levels(y, x) = std::clamp(static_cast<int>(grey(y, x) * TextureStatistics::kLevels), 0,
                                TextureStatistics::kLevels - 1);
    }
  }
  return levels;
}

Cooccurrence cooccurrenceOf(const cv::Mat1i& levels, int distance) {
  const std::array<cv::Point, 4> directions{cv::Point(distance, 0), cv::Point(distance, -distance),
                                            cv::Point(0, distance), cv::Point(distance, distance)};
  Cooccurrence counts = Cooccurrence::zeros();
  double pairs = 0;
  const cv::Rect frame({}, levels.size());
  for (const cv::Point& by : directions) {
    const cv::Rect from = frame & (frame - by);
    for (int y = from.y; y < from.br().y; ++y) {
      for (int x = from.x; x < from.br().x; ++x) {
        const int a = levels(y, x);
        const int b = levels(y + by.y, x + by.x);
        counts(a, b) += 1;
        counts(b, a) += 1;
        pairs += 2;
      }
    }
  }
  return pairs > 0 ? counts * (1.0 / pairs) : counts;
}

/// Spectrum at the scale of marks; coarser structure belongs to the image.
std::vector<double> spectrumOf(const cv::Mat1f& whole) {
  constexpr double kSigmaPixels = 6.0;
  cv::Mat1f grey;
  cv::GaussianBlur(whole, grey, {}, kSigmaPixels);
  cv::subtract(whole, grey, grey);
  const int side = std::min(grey.rows, grey.cols);
  const cv::Rect middle((grey.cols - side) / 2, (grey.rows - side) / 2, side, side);
  cv::Mat1f window;
  cv::createHanningWindow(window, {side, side}, CV_32F);
  cv::Mat1f tapered;
  cv::subtract(grey(middle), cv::mean(grey(middle)), tapered);
  tapered = tapered.mul(window);
  cv::Mat2f transform;
  cv::dft(tapered, transform, cv::DFT_COMPLEX_OUTPUT);
  std::vector<double> power(kSpectrumSteps, 0.0);
  double all = 0;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const double fx = static_cast<double>(std::min(x, side - x)) / side;
      const double fy = static_cast<double>(std::min(y, side - y)) / side;
      const auto step = static_cast<std::size_t>(std::hypot(fx, fy) / 0.5 * kSpectrumSteps);
      if (step >= kSpectrumSteps) continue;
      const cv::Vec2f& value = transform(y, x);
      const double each = static_cast<double>(value.dot(value));
      power[step] += each;
      all += each;
    }
  }
  if (all > 0) {
    for (double& each : power) each /= all;
  }
  return power;
}

/// The centroid of a spectrum, in its bins.
double meanFrequency(const std::vector<double>& spectrum) {
  double sum = 0;
  double weight = 0;
  for (std::size_t i = 0; i < spectrum.size(); ++i) {
    const double frequency = static_cast<double>(i) + 0.5;
    sum += spectrum[i] * frequency;
    weight += spectrum[i];
  }
  return weight > 0 ? sum / weight : 0;
}

/// Sum over one member of all pairs.
template <class Range, class Member>
TextureStatistics sumOf(const Range& pairs, Member member) {
  TextureStatistics sum;
  for (const auto& pair : pairs) sum += pair.*member;
  return sum;
}

/// Logarithm of the local scale of the motion at a pixel, as a length.
std::optional<double> logScaleAt(const MotionMap& motion, int x, int y) {
  constexpr int kSpan = 4;
  const auto at = [&motion](int column, int row) {
    return displacementAt(motion, {static_cast<float>(column), static_cast<float>(row)});
  };
  const auto here = at(x, y);
  const auto right = at(x + kSpan, y);
  const auto below = at(x, y + kSpan);
  if (!here || !right || !below) return std::nullopt;
  const cv::Point2f alongX = (*right - *here) / static_cast<float>(kSpan) + cv::Point2f(1, 0);
  const cv::Point2f alongY = (*below - *here) / static_cast<float>(kSpan) + cv::Point2f(0, 1);
  const double area = static_cast<double>(alongX.cross(alongY));
  return area > 0 ? std::optional(0.5 * std::log(area)) : std::nullopt;
}

}  // namespace

TextureStatistics& TextureStatistics::operator+=(const TextureStatistics& other) {
  for (std::size_t i = 0; i < cooccurrences.size(); ++i) {
    cooccurrences.at(i) += other.cooccurrences.at(i);
  }
  spectrum.resize(std::max(spectrum.size(), other.spectrum.size()));
  for (std::size_t i = 0; i < other.spectrum.size(); ++i) spectrum[i] += other.spectrum[i];
  return *this;
}

TextureStatistics textureOf(const cv::Mat1f& grey) {
  const cv::Mat1f inner = grey(innerRect(grey.size()));
  TextureStatistics statistics;
  const cv::Mat1i levels = levelsOf(inner);
  for (std::size_t i = 0; i < TextureStatistics::kDistances.size(); ++i) {
    statistics.cooccurrences.at(i) = cooccurrenceOf(levels, TextureStatistics::kDistances.at(i));
  }
  statistics.spectrum = spectrumOf(inner);
  return statistics;
}

TextureDifference differenceOf(const TextureStatistics& a, const TextureStatistics& b) {
  TextureDifference difference;
  for (std::size_t i = 0; i < a.cooccurrences.size(); ++i) {
    const Cooccurrence& one = a.cooccurrences.at(i);
    const Cooccurrence& other = b.cooccurrences.at(i);
    difference.cooccurrenceError += 0.5 * cv::norm(one - other, cv::NORM_L1);
  }
  difference.cooccurrenceError /= static_cast<double>(a.cooccurrences.size());
  for (std::size_t i = 0; i < std::min(a.spectrum.size(), b.spectrum.size()); ++i) {
    difference.spectrumError += 0.5 * std::abs(a.spectrum[i] - b.spectrum[i]);
  }
  const double frequency = meanFrequency(a.spectrum);
  if (frequency > 0) difference.frequencyRatio = meanFrequency(b.spectrum) / frequency;
  return difference;
}

void FlatnessMeasures::add(const cv::Mat3f& input, const cv::Mat3f& output) {
  Pair pair{.input = textureOf(greyOf(input)), .output = textureOf(greyOf(output))};
  if (first_.size() < kEnds) first_.push_back(pair);
  last_.push_back(std::move(pair));
  if (last_.size() > kEnds) last_.pop_front();
}

void FlatnessMeasures::follow(const MotionMap& motion) {
  constexpr int kStep = 16;
  if (motion.shift) return;
  std::vector<double> logs;
  const cv::Rect inner = innerRect(motion.valid.size());
  for (int y = inner.y; y < inner.br().y; y += kStep) {
    for (int x = inner.x; x < inner.br().x; x += kStep) {
      if (const auto log = logScaleAt(motion, x, y)) logs.push_back(*log);
    }
  }
  if (logs.empty()) return;
  logScale_ += hal::medianOf(logs);
}

double FlatnessMeasures::scale() const {
  return std::exp(logScale_);
}

std::optional<Flatness> FlatnessMeasures::total() const {
  if (last_.size() < kEnds || std::abs(logScale_) < std::log(kMinScale)) return std::nullopt;
  const auto differenceOver = [this](auto member) {
    TextureStatistics first = sumOf(first_, member);
    TextureStatistics last = sumOf(last_, member);
    for (TextureStatistics* each : {&first, &last}) {
      for (auto& matrix : each->cooccurrences) matrix *= 1.0 / kEnds;
      for (double& power : each->spectrum) power /= kEnds;
    }
    return differenceOf(first, last);
  };
  return Flatness{.scale = scale(),
                  .painting = differenceOver(&Pair::output),
                  .input = differenceOver(&Pair::input)};
}

}  // namespace pleinair::measure
