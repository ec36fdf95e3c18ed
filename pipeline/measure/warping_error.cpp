#include "pipeline/measure/warping_error.h"

#include <algorithm>
#include <cassert>
#include <cmath>

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

}  // namespace pleinair::measure
