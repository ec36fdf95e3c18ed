#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

namespace pleinair::tracking {

/// A face that a FaceDetector has found: the square from the brows to the chin, px of the image.
struct FoundFace {
  cv::Point2f centre;
  float sidePx = 0.0F;
  int hits = 0;  ///< places and sizes at which it was found: the more, the surer
};

/// Finds upright faces that look at the camera, by a cascade of boosted classifiers (Viola & Jones,
/// "Rapid object detection using a boosted cascade of simple features", 2001; Lienhart & Maydt,
/// 2002). It looks for them step by step, in strips of the image and
/// sizes of faces, so that a frame costs a part of a search only. One thread at a time; uses
/// OpenCV's threads.
class FaceDetector {
 public:
  /// `cascade`: one of faceCascades(). Throws hal::Failure if OpenCV does not read it.
  explicit FaceDetector(std::string_view cascade);
  ~FaceDetector();
  FaceDetector(const FaceDetector&) = delete;
  FaceDetector& operator=(const FaceDetector&) = delete;
  FaceDetector(FaceDetector&&) = delete;
  FaceDetector& operator=(FaceDetector&&) = delete;

  /// Faces are at least so wide, px of the image.
  static constexpr int kLeastSidePx = 20;
  static constexpr int kLeastHits = 2;  ///< of a face that is reported

  /// Searches on in `image` (CV_8UC1) for this part of a search, in (0, 1]; an image of another
  /// size begins anew. True when all of a search has been done: found() is new.
  bool search(const cv::Mat& image, double part);
  /// Looks for a face in this image that was found in an earlier one: less than half its side from
  /// there, and of about its size. Nothing if there is none.
  std::optional<FoundFace> findNear(const cv::Mat& image, const FoundFace& earlier);
  /// What the last whole search found, the surest first.
  const std::vector<FoundFace>& found() const;
  /// Begins anew, and forgets what was found.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::tracking
