#include "pipeline/measure/mover_masks.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "hal/median.h"
#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

constexpr std::size_t kMedianFrames = 41;
constexpr int kSmallest = 60;  // px of a mover
constexpr int kWithin = 2;
constexpr int kClose = 3;
constexpr int kNear = 12;

cv::Mat diskOf(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

cv::Mat3b medianOf(const std::vector<cv::Mat3b>& inputs) {
  const std::size_t count = std::min(kMedianFrames, inputs.size());
  std::vector<const cv::Mat3b*> some;
  for (std::size_t i = 0; i < count; ++i) {
    some.push_back(&inputs[i * (inputs.size() - 1) / std::max<std::size_t>(count - 1, 1)]);
  }
  cv::Mat3b median(inputs.front().size());
  std::vector<std::uint8_t> values(count);
  for (int y = 0; y < median.rows; ++y) {
    for (int x = 0; x < median.cols; ++x) {
      for (int c = 0; c < 3; ++c) {
        for (std::size_t i = 0; i < count; ++i) values[i] = (*some[i])(y, x)[c];
        median(y, x)[c] = hal::medianOf(values);
      }
    }
  }
  return median;
}

cv::Mat1b clearlyDiffering(const cv::Mat3b& a, const cv::Mat3b& b) {
  cv::Mat1b mask(a.size());
  for (int y = 0; y < a.rows; ++y) {
    for (int x = 0; x < a.cols; ++x) {
      mask(y, x) = largestDifference(a(y, x), b(y, x)) > kContrastLevels ? 255 : 0;
    }
  }
  return mask;
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

}  // namespace

int largestDifference(const cv::Vec3b& a, const cv::Vec3b& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

double meanDifference(const cv::Vec3b& a, const cv::Vec3b& b) {
  return (std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2])) / 3.0;
}

std::vector<cv::Mat1b> findMovers(const std::vector<cv::Mat3b>& inputs) {
  const cv::Mat3b ground = medianOf(inputs);
  std::vector<cv::Mat1b> movers;
  for (const cv::Mat3b& input : inputs) {
    cv::Mat1b mask = clearlyDiffering(input, ground);
    cv::morphologyEx(mask, mask, cv::MORPH_OPEN, diskOf(1));
    cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, diskOf(3));
    removeSpecks(mask);
    movers.push_back(std::move(mask));
  }
  return movers;
}

cv::Mat1b grown(const cv::Mat1b& mask, int radius) {
  cv::Mat1b larger;
  cv::dilate(mask, larger, diskOf(radius));
  return larger;
}

cv::Mat1b eroded(const cv::Mat1b& mask, int radius) {
  cv::Mat1b smaller;
  cv::erode(mask, smaller, diskOf(radius));
  return smaller;
}

cv::Mat1b displaced(const cv::Mat1b& mask) {
  cv::Mat1b moved(mask.size(), 0);
  const cv::Rect from(0, 0, mask.cols - kDisplacementPixels, mask.rows - kDisplacementPixels);
  mask(from).copyTo(moved(from + cv::Point(kDisplacementPixels, kDisplacementPixels)));
  return moved;
}

Mean shareWithinBorder(const cv::Mat1b& mask) {
  const cv::Rect inner = innerRect(mask.size());
  return {static_cast<double>(cv::countNonZero(mask(inner))), static_cast<double>(inner.area())};
}

MoverZones::MoverZones(const cv::Mat1b& movers)
    : mover(movers),
      within(eroded(movers, kWithin)),
      close(grown(movers, kClose)),
      near(grown(movers, kNear)),
      far(grown(movers, kFarPixels)) {}

}  // namespace pleinair::measure
