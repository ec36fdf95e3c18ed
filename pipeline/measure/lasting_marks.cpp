#include "pipeline/measure/lasting_marks.h"

#include <vector>

#include <opencv2/imgproc.hpp>

namespace pleinair::measure {
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

}  // namespace pleinair::measure
