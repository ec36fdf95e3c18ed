#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "hal/pixel_format.h"

namespace pleinair::tracking {

/// The point to which a homography moves `px`.
glm::dvec2 movedBy(const glm::dmat3& homography, const glm::dvec2& px);

/// Visits the centres of a grid of cells over an image. Averages over the image are taken there.
template <class F>
void forGridCentres(hal::FrameSize size, F&& visit) {
  constexpr int kAcross = 5;
  constexpr int kDown = 4;
  for (int j = 0; j < kDown; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      visit(glm::dvec2((i + 0.5) / kAcross * size.width, (j + 0.5) / kDown * size.height));
    }
  }
}

/// Root mean square displacement by a homography, over the whole image.
double rmsMotion(const glm::dmat3& homography, hal::FrameSize size);

/// The positions of one point in two frames, px of the frame.
struct PointPair {
  glm::dvec2 previous{0.0};
  glm::dvec2 current{0.0};
  double errorPx = 0.0;  ///< predicted error of (now - then)
};

struct HomographyFit {
  glm::dmat3 currentFromPrevious{1.0};
  double fitErrorPx = 0.0;  ///< predicted error of where it moves a point, averaged over the image
  double modelErrorPx = 0.0;  ///< deviation of the points beyond their predicted errors
  std::size_t agreeing = 0;
};

/// Fits homographies to point pairs with outliers: RANSAC finds the agreeing pairs, then weighted
/// least squares uses all of them. One thread at a time.
class HomographyFitter {
 public:
  /// Returns nothing where too few pairs agree, or where they cover too little of the image.
  std::optional<HomographyFit> fit(std::span<const PointPair> pairs, hal::FrameSize size);
  /// Whether pair `i` of the last fit agrees with it.
  bool agrees(std::size_t i) const { return agrees_[i] != 0; }

 private:
  using Vector8 = cv::Vec<double, 8>;
  using Matrix8 = cv::Matx<double, 8, 8>;
  bool findAgreeing(std::span<const PointPair> pairs, hal::FrameSize size, glm::dmat3& start);
  struct Sums;
  Sums accumulate(std::span<const PointPair> pairs, hal::FrameSize size, const Vector8& h,
                  double excess) const;
  std::optional<HomographyFit> refine(std::span<const PointPair> pairs, hal::FrameSize size,
                                      const glm::dmat3& start) const;
  bool coversEnough(std::span<const PointPair> pairs, hal::FrameSize size) const;

  std::vector<cv::Point2f> from_;
  std::vector<cv::Point2f> to_;
  std::vector<unsigned char> agrees_;
};

}  // namespace pleinair::tracking
