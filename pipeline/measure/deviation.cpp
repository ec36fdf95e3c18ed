#include "pipeline/measure/deviation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
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

Mean meanSquare(const cv::Mat3f& picture) {
  const cv::Mat inner = picture(innerRect(picture.size()));
  const double norm = cv::norm(inner, cv::NORM_L2);
  return {norm * norm, 3.0 * static_cast<double>(inner.total())};
}

Mean absoluteDifference(const cv::Mat3f& a, const cv::Mat3f& b) {
  const cv::Rect inner = innerRect(a.size());
  return {cv::norm(a(inner), b(inner), cv::NORM_L1), 3.0 * static_cast<double>(inner.area())};
}

}  // namespace pleinair::measure
