#include "pipeline/tracking/faces/face_detector.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>

#include <opencv2/objdetect.hpp>

#include "hal/error.h"

namespace pleinair::tracking {
namespace {

constexpr double kSizeRatio = 1.1;  // from a size of faces to the next
/// The classifier's window is moved by a pixel of the reduced image above this reduction, by two
/// below it (cv::CascadeClassifier).
constexpr double kFineStepFrom = 2.0;
/// How far around a face it is looked for again, in its sides, and how much larger or smaller.
constexpr float kNearSides = 1.0F;
constexpr float kNearRatio = 1.25F;
constexpr double kGroupTolerance = 0.25;  // of a face's side: hits that are one face

/// A size of faces, and what looking for it in the whole image costs.
struct FaceSize {
  int sidePx;
  double cost;
};

std::vector<FaceSize> sizesFor(cv::Size image) {
  std::vector<FaceSize> sizes;
  for (double reduction = 1.0;; reduction *= kSizeRatio) {
    const int side = cvRound(FaceDetector::kLeastSidePx * reduction);
    if (side >= std::min(image.width, image.height)) return sizes;
    const double perPlace = reduction > kFineStepFrom ? 1.0 : 0.25;
    const double places = static_cast<double>(image.width - side) * (image.height - side);
    sizes.push_back({side, perPlace * places / (reduction * reduction)});
  }
}

bool comesBefore(const cv::Rect& a, const cv::Rect& b) {
  return std::tie(a.y, a.x, a.width) < std::tie(b.y, b.x, b.width);
}

FoundFace faceOf(cv::Point2f corner, float side, int hits) {
  const float middle = 0.5F * side - 0.5F;
  return {corner + cv::Point2f(middle, middle), side, hits};
}

}  // namespace

struct FaceDetector::State {
  cv::CascadeClassifier classifier;
  cv::Size image;
  std::vector<FaceSize> sizes;
  double wholeCost = 0.0;
  std::size_t size = 0;  // the next one that is looked for
  int row = 0;           // the first one where it has not been
  std::vector<cv::Rect> hits;
  std::vector<cv::Rect> some;
  std::vector<int> counts;
  std::vector<FoundFace> found;

  void begin(cv::Size given) {
    image = given;
    sizes = sizesFor(image);
    wholeCost = 0.0;
    for (const FaceSize& each : sizes) wholeCost += each.cost;
    restart();
  }
  void restart() {
    size = 0;
    row = 0;
    hits.clear();
  }
  double searchStrip(const cv::Mat& picture, double cost);
  void group();
};

/// Looks for the next size in as many rows as the cost allows; gives the cost.
double FaceDetector::State::searchStrip(const cv::Mat& picture, double cost) {
  const FaceSize& looked = sizes[size];
  const int rows = image.height - looked.sidePx;
  const double costOfRow = looked.cost / rows;
  // A strip of fewer rows costs more for what its neighbours share.
  const int least = std::max(1, looked.sidePx / 4);
  int count = std::max(least, static_cast<int>(std::lround(cost / costOfRow)));
  if (rows - row - count < least) count = rows - row;
  const cv::Rect strip(0, row, image.width, std::min(count + looked.sidePx, image.height - row));
  const cv::Size side(looked.sidePx, looked.sidePx);
  classifier.detectMultiScale(picture(strip), some, kSizeRatio, 0, 0, side, side);
  for (const cv::Rect& each : some) hits.push_back(each + strip.tl());
  row += count;
  if (row >= rows) {
    row = 0;
    ++size;
  }
  return count * costOfRow;
}

/// One face of all hits beside each other.
void FaceDetector::State::group() {
  std::ranges::sort(hits, comesBefore);  // threads found them in any order
  cv::groupRectangles(hits, counts, kLeastHits - 1, kGroupTolerance);
  found.clear();
  for (std::size_t i = 0; i < hits.size(); ++i) {
    found.push_back(faceOf(hits[i].tl(), static_cast<float>(hits[i].width), counts[i]));
  }
  std::ranges::sort(found, [](const FoundFace& a, const FoundFace& b) {
    return std::tie(b.hits, a.centre.y, a.centre.x, a.sidePx) <
           std::tie(a.hits, b.centre.y, b.centre.x, b.sidePx);
  });
}

FaceDetector::FaceDetector(std::string_view cascade) : state_(std::make_unique<State>()) {
  const cv::FileStorage file(std::string(cascade), cv::FileStorage::READ | cv::FileStorage::MEMORY);
  if (!state_->classifier.read(file.getFirstTopLevelNode())) {
    throw hal::Failure({.kind = hal::ErrorKind::kInternal,
                        .subject = "face detector",
                        .problem = "OpenCV does not read the classifier that it came with"});
  }
}

FaceDetector::~FaceDetector() = default;

bool FaceDetector::search(const cv::Mat& image, double part) {
  assert(image.type() == CV_8UC1 && part > 0.0);
  State& s = *state_;
  if (s.image != image.size()) {
    s.begin(image.size());
    s.found.clear();
  }
  double left = part * s.wholeCost;
  while (s.size < s.sizes.size() && left > 0.0) left -= s.searchStrip(image, left);
  if (s.size < s.sizes.size()) return false;
  s.group();
  s.restart();
  return true;
}

std::optional<FoundFace> FaceDetector::findNear(const cv::Mat& image, const FoundFace& earlier) {
  State& s = *state_;
  const int reach = cvRound(kNearSides * earlier.sidePx);
  const cv::Rect all({}, image.size());
  const cv::Rect around = all & cv::Rect(cvRound(earlier.centre.x) - reach,
                                         cvRound(earlier.centre.y) - reach, 2 * reach, 2 * reach);
  const int least = std::max(kLeastSidePx, cvRound(earlier.sidePx / kNearRatio));
  const int largest = cvRound(earlier.sidePx * kNearRatio);
  if (std::min(around.width, around.height) < least) return std::nullopt;
  s.classifier.detectMultiScale(image(around), s.some, kSizeRatio, 0, 0, {least, least},
                                {largest, largest});
  std::ranges::sort(s.some, comesBefore);
  cv::groupRectangles(s.some, s.counts, kLeastHits - 1, kGroupTolerance);
  if (s.some.empty()) return std::nullopt;
  const auto most = std::ranges::max_element(s.counts);
  const cv::Rect& box = s.some[static_cast<std::size_t>(most - s.counts.begin())];
  return faceOf(box.tl() + around.tl(), static_cast<float>(box.width),
                std::max(earlier.hits, *most));
}

const std::vector<FoundFace>& FaceDetector::found() const {
  return state_->found;
}

void FaceDetector::reset() {
  state_->restart();
  state_->found.clear();
}

}  // namespace pleinair::tracking
