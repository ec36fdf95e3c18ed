#include "pipeline/inspection/structure_match.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::inspection {
namespace {

constexpr int kBlockPx = 20;
constexpr int kStridePx = 10;
constexpr int kCoarseShiftPx = 8;  ///< of the whole picture: errors of the pose
constexpr int kFineShiftPx = 3;    ///< of a block: relief seen from another place
constexpr double kSmoothPx = 1.5;
/// Sobel's answer on the logarithm of the luma, from which on a pixel is on an edge: 1.5 % a pixel,
/// above a sensor's noise. In the second picture weaker ones count.
constexpr double kEdge = 0.12;
constexpr double kSeenEdge = 0.08;
/// Pixels on edges that a block needs, of its 400.
constexpr double kMinEdgePx = 24.0;

cv::Mat matrixOf(const hal::ImageView& image) {
  const hal::PlaneView& plane = image.planes[0];
  const cv::Mat bytes(image.format.size.height, image.format.size.width, CV_8UC1,
                      const_cast<std::uint8_t*>(plane.bytes.data()),  // NOLINT(*-const-cast): read
                      plane.strideBytes);
  cv::Mat matrix;
  bytes.convertTo(matrix, CV_32F);
  cv::GaussianBlur(matrix, matrix, {}, kSmoothPx);
  return matrix;
}

/// The directions of edges: unit gradients of the logarithm of the luma, which light multiplies,
/// and zero off edges.
cv::Mat edgeDirections(const cv::Mat& luma, double threshold) {
  constexpr double kBlack = 8.0;  // grey levels: the logarithm of noise in the dark stays small
  cv::Mat logarithm;
  cv::log(luma + kBlack, logarithm);
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(logarithm, dx, CV_32F, 1, 0);
  cv::Sobel(logarithm, dy, CV_32F, 0, 1);
  cv::Mat strength;
  cv::magnitude(dx, dy, strength);
  const cv::Mat isFlat = strength < threshold;
  strength.setTo(1.0, isFlat);
  cv::Mat directions;
  cv::merge(std::vector<cv::Mat>{dx / strength, dy / strength}, directions);
  directions.setTo(cv::Scalar(0.0, 0.0), isFlat);
  return directions;
}

/// Pixels on edges: each has a direction of length 1.
double edgePixels(const cv::Mat& directions) {
  return cv::norm(directions, cv::NORM_L2SQR);
}

struct Found {
  double agreement = 0.0;
  cv::Point shift;
};

/// The best agreement of a block's edges with those of `seen` at places up to `shift` px around:
/// the mean cosine between their directions. Nothing where these places are beside the picture, or
/// the block has too few edges.
std::optional<Found> find(const cv::Mat& expected, const cv::Mat& seen, const cv::Rect& block,
                          cv::Point around, int shift) {
  const double edges = edgePixels(expected(block));
  if (edges < kMinEdgePx) return std::nullopt;
  const cv::Rect wanted(block.x + around.x - shift, block.y + around.y - shift,
                        block.width + 2 * shift, block.height + 2 * shift);
  const cv::Rect region = wanted & cv::Rect({0, 0}, seen.size());
  if (region.width < block.width || region.height < block.height) return std::nullopt;
  cv::Mat sums;
  cv::matchTemplate(seen(region), expected(block), sums, cv::TM_CCORR);
  double best = 0.0;
  cv::Point at;
  cv::minMaxLoc(sums, nullptr, &best, nullptr, &at);
  return Found{best / edges, region.tl() + at - block.tl()};
}

/// The agreement of the blocks, by rows; nothing where a block does not count.
class BlockGrid {
 public:
  BlockGrid(const cv::Mat& expected, const cv::Mat& seen)
      : across_((expected.cols - kBlockPx) / kStridePx + 1),
        down_((expected.rows - kBlockPx) / kStridePx + 1) {
    const cv::Rect inner(kCoarseShiftPx, kCoarseShiftPx, expected.cols - 2 * kCoarseShiftPx,
                         expected.rows - 2 * kCoarseShiftPx);
    const auto whole = find(expected, seen, inner, {}, kCoarseShiftPx);
    const cv::Point around = whole ? whole->shift : cv::Point();
    const double radius = 0.5 * std::min(expected.cols, expected.rows);
    for (int row = 0; row < down_; ++row) {
      for (int column = 0; column < across_; ++column) {
        const cv::Rect block(column * kStridePx, row * kStridePx, kBlockPx, kBlockPx);
        const double dx = block.x + 0.5 * kBlockPx - 0.5 * expected.cols;
        const double dy = block.y + 0.5 * kBlockPx - 0.5 * expected.rows;
        const bool counts = std::hypot(dx, dy) <= radius;
        scores_.push_back(counts ? scoreOf(expected, seen, block, around) : std::nullopt);
        counted_ += counts ? 1 : 0;
      }
    }
  }

  StructureMatch match() const {
    StructureMatch match{.worst = 1.0};
    int structured = 0;
    for (const auto& score : scores_) {
      if (!score) continue;
      match.mean += *score;
      ++structured;
    }
    match.mean /= std::max(structured, 1);
    match.structured = static_cast<double>(structured) / std::max(counted_, 1);
    for (int row = 0; row < down_; ++row) {
      for (int column = 0; column < across_; ++column) {
        if (const auto around = neighbourhood(row, column)) {
          match.worst = std::min(match.worst, *around);
        }
      }
    }
    return match;
  }

 private:
  static std::optional<double> scoreOf(const cv::Mat& expected, const cv::Mat& seen,
                                       const cv::Rect& block, cv::Point around) {
    const auto found = find(expected, seen, block, around, kFineShiftPx);
    return found ? std::optional(found->agreement) : std::nullopt;
  }

  /// The mean of the blocks around one, where enough of them count.
  std::optional<double> neighbourhood(int row, int column) const {
    constexpr int kEnough = 3;
    double sum = 0.0;
    int count = 0;
    for (int y = std::max(row - 1, 0); y <= std::min(row + 1, down_ - 1); ++y) {
      for (int x = std::max(column - 1, 0); x <= std::min(column + 1, across_ - 1); ++x) {
        const auto& score = scores_.at(static_cast<std::size_t>(y * across_ + x));
        if (!score) continue;
        sum += *score;
        ++count;
      }
    }
    return count >= kEnough ? std::optional(sum / count) : std::nullopt;
  }

  int across_;
  int down_;
  int counted_ = 0;
  std::vector<std::optional<double>> scores_;
};

}  // namespace

StructureMatch matchStructure(const hal::ImageView& expected, const hal::ImageView& seen) {
  assert(expected.format.size == seen.format.size && expected.format.size.width >= 64);
  const cv::Mat first = matrixOf(expected);
  const cv::Mat second = matrixOf(seen);
  StructureMatch match =
      BlockGrid(edgeDirections(first, kEdge), edgeDirections(second, kSeenEdge)).match();
  match.brightness = cv::mean(second)[0];
  return match;
}

}  // namespace pleinair::inspection
