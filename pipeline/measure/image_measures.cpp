#include "pipeline/measure/image_measures.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

/// Calls visit(difference) for each valid pixel.
template <class Visit>
void forEachDifference(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later, Visit visit) {
  assert(earlier.size() == later.picture.size());
  for (int y = 0; y < earlier.rows; ++y) {
    const cv::Vec3f* a = earlier[y];
    const cv::Vec3f* b = later.picture[y];
    const unsigned char* mask = later.mask[y];
    for (int x = 0; x < earlier.cols; ++x) {
      if (mask[x] != 0) visit(y, x, a[x] - b[x]);
    }
  }
}

}  // namespace

Mean warpingError(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later) {
  Mean mean;
  forEachDifference(earlier, later, [&mean](int, int, const cv::Vec3f& difference) {
    mean.sum += static_cast<double>(difference.dot(difference)) / 3.0;
    mean.weight += 1.0;
  });
  return mean;
}

Mean poppedShare(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later) {
  // Slightly more, so that rounding does not decide about a difference of 24 whole levels.
  constexpr float kPop = 24.001F / 255.0F;
  Mean mean;
  forEachDifference(earlier, later, [&mean](int, int, const cv::Vec3f& difference) {
    const float largest =
        std::max({std::abs(difference[0]), std::abs(difference[1]), std::abs(difference[2])});
    mean.sum += largest > kPop ? 1.0 : 0.0;
    mean.weight += 1.0;
  });
  return mean;
}

cv::Mat3f differenceAlong(const cv::Mat3f& earlier, const Warped<cv::Mat3f>& later) {
  cv::Mat3f picture(earlier.size(), cv::Vec3f());
  forEachDifference(earlier, later, [&picture](int y, int x, const cv::Vec3f& difference) {
    picture(y, x) = {std::abs(difference[0]), std::abs(difference[1]), std::abs(difference[2])};
  });
  return picture;
}

namespace {

constexpr int kMaxMarks = 300;
constexpr double kQuality = 0.01;
constexpr double kApartPixels = 8;
constexpr int kPatchRadius = 6;
constexpr int kSearchRadius = kPatchRadius + 1;
constexpr double kFound = 0.8;

cv::Rect around(cv::Point centre, int radius) {
  return {centre.x - radius, centre.y - radius, 2 * radius + 1, 2 * radius + 1};
}

bool isFoundAgain(const cv::Mat1f& earlier, const cv::Mat1f& later, cv::Point at) {
  cv::Mat1f correlations;
  cv::matchTemplate(later(around(at, kSearchRadius)), earlier(around(at, kPatchRadius)),
                    correlations, cv::TM_CCOEFF_NORMED);
  double best = 0;
  cv::minMaxLoc(correlations, nullptr, &best);
  return best > kFound;
}

}  // namespace

Mean lastingMarks(const cv::Mat1f& earlier, const Warped<cv::Mat1f>& later) {
  cv::Mat1b whole;  // where the whole patch and its search area are valid
  cv::erode(
      later.mask, whole,
      cv::getStructuringElement(cv::MORPH_RECT, {2 * kSearchRadius + 1, 2 * kSearchRadius + 1}),
      {-1, -1}, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  std::vector<cv::Point2f> marks;
  cv::goodFeaturesToTrack(earlier, marks, kMaxMarks, kQuality, kApartPixels, whole);
  Mean found;
  for (const cv::Point2f& mark : marks) {
    const bool isFound = isFoundAgain(earlier, later.picture, cv::Point(mark));
    found.sum += isFound ? 1.0 : 0.0;
    found.weight += 1.0;
  }
  return found;
}

namespace {

/// Moments of one channel for fitting a straight line through (I, O).
struct Moments {
  double count = 0, i = 0, o = 0, ii = 0, io = 0, oo = 0;

  void add(double input, double output) {
    count += 1;
    i += input;
    o += output;
    ii += input * input;
    io += input * output;
    oo += output * output;
  }
  /// Sum of squared residuals of the best line.
  double residual() const {
    const double varianceI = ii - i * i / count;
    const double varianceO = oo - o * o / count;
    const double covariance = io - i * o / count;
    const double explained = varianceI > 0 ? covariance * covariance / varianceI : 0;
    return std::max(0.0, varianceO - explained);
  }
  /// The best line, by its gain and its value at 0; a mere shift where the input varies by less
  /// than `leastDeviation`.
  std::pair<double, double> line(double leastDeviation) const {
    if (!(count > 0)) return {1.0, 0.0};
    const double varianceI = ii / count - i / count * (i / count);
    const double covariance = io / count - i / count * (o / count);
    const bool varies = varianceI >= leastDeviation * leastDeviation;
    const double gain = varies ? covariance / varianceI : 1.0;
    return {gain, (o - gain * i) / count};
  }
};

}  // namespace

Mean deviation(const cv::Mat3f& output, const cv::Mat3f& input) {
  const cv::Rect inner = innerRect(output.size());
  std::array<Moments, 3> channels;
  for (int y = inner.y; y < inner.br().y; ++y) {
    for (int x = inner.x; x < inner.br().x; ++x) {
      const cv::Vec3f& o = output(y, x);
      const cv::Vec3f& i = input(y, x);
      for (int c = 0; c < 3; ++c) {
        channels.at(static_cast<std::size_t>(c))
            .add(static_cast<double>(i[c]), static_cast<double>(o[c]));
      }
    }
  }
  Mean mean;
  for (const Moments& channel : channels) mean += {channel.residual(), channel.count};
  return mean;
}

cv::Mat3b inPaletteOf(const cv::Mat3b& painting, const cv::Mat3b& input, const cv::Mat1b& without) {
  constexpr double kLeastDeviation = 8.0;  // levels: less tells no gain
  const cv::Rect inner = innerRect(input.size());
  cv::Mat3b matched(input.size());
  for (int c = 0; c < 3; ++c) {
    Moments channel;
    for (int y = inner.y; y < inner.br().y; ++y) {
      for (int x = inner.x; x < inner.br().x; ++x) {
        if (without(y, x) == 0) channel.add(input(y, x)[c], painting(y, x)[c]);
      }
    }
    const auto [gain, offset] = channel.line(kLeastDeviation);
    for (int y = 0; y < input.rows; ++y) {
      for (int x = 0; x < input.cols; ++x) {
        matched(y, x)[c] = cv::saturate_cast<std::uint8_t>(gain * input(y, x)[c] + offset);
      }
    }
  }
  return matched;
}

Mean meanSquare(const cv::Mat3f& picture) {
  const cv::Mat inner = picture(innerRect(picture.size()));
  const double norm = cv::norm(inner, cv::NORM_L2);
  return {norm * norm, 3.0 * static_cast<double>(inner.total())};
}

Mean absoluteDifference(const cv::Mat3f& a, const cv::Mat3f& b) {
  const cv::Rect inner = innerRect(a.size());
  return {cv::norm(a(inner), b(inner), cv::NORM_L1), 3.0 * static_cast<double>(inner.area())};
}

cv::Mat1f relativeGradient(const cv::Mat1f& grey) {
  constexpr double kSigmaPixels = 8.0;
  constexpr double kFloor = 1.0 / 255.0;
  cv::Mat1f alongX;
  cv::Mat1f alongY;
  cv::Sobel(grey, alongX, CV_32F, 1, 0);
  cv::Sobel(grey, alongY, CV_32F, 0, 1);
  cv::Mat1f strength;
  cv::magnitude(alongX, alongY, strength);
  cv::Mat1f mean;
  cv::GaussianBlur(strength, mean, {}, kSigmaPixels);
  mean += kFloor;
  cv::Mat1f relative;
  cv::divide(strength, mean, relative);
  return relative;
}

std::optional<double> screenCorrelation(const cv::Mat1f& earlier, const cv::Mat1f& later,
                                        const cv::Mat1b& mask) {
  cv::Scalar meanA, meanB, deviationA, deviationB;
  cv::meanStdDev(earlier, meanA, deviationA, mask);
  cv::meanStdDev(later, meanB, deviationB, mask);
  double products = 0;
  double count = 0;
  for (int y = 0; y < mask.rows; ++y) {
    for (int x = 0; x < mask.cols; ++x) {
      if (mask(y, x) == 0) continue;
      products += (static_cast<double>(earlier(y, x)) - meanA[0]) *
                  (static_cast<double>(later(y, x)) - meanB[0]);
      count += 1;
    }
  }
  const double scale = deviationA[0] * deviationB[0] * count;
  if (!(scale > 0)) return std::nullopt;
  return products / scale;
}

}  // namespace pleinair::measure
