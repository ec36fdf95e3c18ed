#include "pipeline/inspection/structure_match.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <map>
#include <numeric>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace pleinair::inspection {
namespace {

constexpr int kBlockPx = 20;
constexpr int kStridePx = 10;
constexpr int kCoarseShiftPx = 8;  ///< of the whole picture: errors of the pose
/// Of a block, beside what relief does: smoothed edges agree within a pixel or two.
constexpr int kSlackPx = 0;
constexpr double kSmoothPx = 2.2;
/// Sobel's answer on the logarithm of the luma, from which on a pixel is on an edge: 1.1 % a pixel,
/// above a sensor's noise. In the second picture weaker ones count.
constexpr double kEdge = 0.09;
constexpr double kSeenEdge = 0.04;
/// Pixels on edges that a block needs, of its 400.
constexpr double kMinEdgePx = 24.0;

cv::Mat bytesOf(const hal::ImageView& image) {
  const hal::PlaneView& plane = image.planes[0];
  return {image.format.size.height, image.format.size.width, CV_8UC1,
          const_cast<std::uint8_t*>(plane.bytes.data()),  // NOLINT(*-const-cast): read
          plane.strideBytes};
}

cv::Mat matrixOf(const hal::ImageView& image) {
  cv::Mat matrix;
  bytesOf(image).convertTo(matrix, CV_32F);
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

/// Where nothing of the relief is, nor within a few pixels: an outline's edge has a width.
cv::Mat placesBeside(std::span<const ReliefPixel> relief, const cv::Size& size) {
  constexpr int kAroundPx = 9;
  cv::Mat isThere(size, CV_8UC1, cv::Scalar(0));
  for (std::size_t i = 0; i < relief.size(); ++i) {
    if (!std::isnan(relief[i].height)) isThere.data[i] = 255;
  }
  cv::dilate(isThere, isThere,
             cv::getStructuringElement(cv::MORPH_ELLIPSE, {kAroundPx, kAroundPx}));
  return isThere == 0;
}

/// The least, mean and largest height; zeros where it is unknown.
std::array<double, 3> heightsOf(std::span<const ReliefPixel> relief) {
  std::array<double, 3> heights{HUGE_VAL, 0.0, -HUGE_VAL};
  int count = 0;
  for (const ReliefPixel& each : relief) {
    if (std::isnan(each.height)) continue;
    heights[0] = std::min<double>(heights[0], each.height);
    heights[1] += each.height;
    heights[2] = std::max<double>(heights[2], each.height);
    ++count;
  }
  if (count == 0) return {};
  heights[1] /= count;
  return heights;
}

/// What of the relief is in a block.
struct BlockRelief {
  double least = 0.0;  ///< height
  double most = 0.0;
  std::size_t part = 0;  ///< that has most of it
};

/// The relief in a block, or near it where there is none in it; heights of -1 and 1 where it is
/// unknown.
BlockRelief reliefIn(std::span<const ReliefPixel> relief, int columns, const cv::Rect& block) {
  if (relief.empty()) return {.least = -1.0, .most = 1.0};
  const int rows = static_cast<int>(relief.size()) / columns;
  for (const int around : {0, 5}) {
    BlockRelief found{.least = HUGE_VAL, .most = -HUGE_VAL};
    std::map<std::size_t, int> counts;
    for (int y = std::max(0, block.y - around); y < std::min(rows, block.br().y + around); ++y) {
      for (int x = std::max(0, block.x - around); x < std::min(columns, block.br().x + around);
           ++x) {
        const ReliefPixel& px = relief[static_cast<std::size_t>(y * columns + x)];
        if (std::isnan(px.height)) continue;
        found.least = std::min<double>(found.least, px.height);
        found.most = std::max<double>(found.most, px.height);
        ++counts[px.part];
      }
    }
    if (counts.empty()) continue;
    found.part =
        std::ranges::max_element(counts, {}, [](const auto& each) { return each.second; })->first;
    return found;
  }
  return {};
}

/// Pixels on edges: each has a direction of length 1.
double edgePixels(const cv::Mat& directions) {
  return cv::norm(directions, cv::NORM_L2SQR);
}

struct Found {
  double agreement = 0.0;
  cv::Point shift;
};

/// Shifts that are tried: within `slack` of those between two.
struct Shifts {
  glm::dvec2 from{0.0};
  glm::dvec2 to{0.0};
  int slack = 0;

  bool holds(const cv::Point& shift) const {
    const glm::dvec2 way = to - from;
    const glm::dvec2 off = glm::dvec2(shift.x, shift.y) - from;
    const double squared = glm::dot(way, way);
    const double t = squared > 0.0 ? std::clamp(glm::dot(off, way) / squared, 0.0, 1.0) : 0.0;
    return glm::length(off - t * way) <= slack + 0.5;
  }
};

/// The best agreement of a block's edges with those of `seen` at shifted places: the mean cosine
/// between their directions. Nothing where these places are beside the picture, or the block has
/// too few edges.
std::optional<Found> find(const cv::Mat& expected, const cv::Mat& seen, const cv::Rect& block,
                          const Shifts& shifts) {
  const double edges = edgePixels(expected(block));
  if (edges < kMinEdgePx) return std::nullopt;
  const glm::dvec2 least = glm::floor(glm::min(shifts.from, shifts.to)) - double(shifts.slack);
  const glm::dvec2 most = glm::ceil(glm::max(shifts.from, shifts.to)) + double(shifts.slack);
  const cv::Rect wanted(block.x + static_cast<int>(least.x), block.y + static_cast<int>(least.y),
                        block.width + static_cast<int>(most.x - least.x),
                        block.height + static_cast<int>(most.y - least.y));
  const cv::Rect region = wanted & cv::Rect({0, 0}, seen.size());
  if (region.width < block.width || region.height < block.height) return std::nullopt;
  cv::Mat sums;
  cv::matchTemplate(seen(region), expected(block), sums, cv::TM_CCORR);
  std::optional<Found> best;
  for (int y = 0; y < sums.rows; ++y) {
    for (int x = 0; x < sums.cols; ++x) {
      const cv::Point shift = region.tl() + cv::Point(x, y) - block.tl();
      const double agreement = sums.at<float>(y, x) / edges;
      if (!shifts.holds(shift) || (best && agreement <= best->agreement)) continue;
      best = Found{agreement, shift};
    }
  }
  return best;
}

/// The agreement of the blocks, by rows; nothing where a block does not count.
class BlockGrid {
 public:
  /// `around`: the shift that heights do not explain.
  BlockGrid(const cv::Mat& expected, const cv::Mat& seen, const StructureSearch& search,
            const glm::dvec2& around)
      : across_((expected.cols - kBlockPx) / kStridePx + 1),
        down_((expected.rows - kBlockPx) / kStridePx + 1) {
    const double radius = 0.5 * std::min(expected.cols, expected.rows);
    for (int row = 0; row < down_; ++row) {
      for (int column = 0; column < across_; ++column) {
        const cv::Rect block(column * kStridePx, row * kStridePx, kBlockPx, kBlockPx);
        const double dx = block.x + 0.5 * kBlockPx - 0.5 * expected.cols;
        const double dy = block.y + 0.5 * kBlockPx - 0.5 * expected.rows;
        const bool counts = std::hypot(dx, dy) <= radius;
        const BlockRelief relief = reliefIn(search.relief, expected.cols, block);
        const Shifts shifts{.from = around + relief.least * search.reliefPx,
                            .to = around + relief.most * search.reliefPx,
                            .slack = kSlackPx};
        scores_.push_back(counts ? scoreOf(expected, seen, block, shifts) : std::nullopt);
        if (!search.relief.empty() && scores_.back())
          byPart_[relief.part].push_back(*scores_.back());
        counted_ += counts ? 1 : 0;
      }
    }
  }

  StructureMatch match() const {
    StructureMatch match;
    int structured = 0;
    for (const auto& score : scores_) {
      if (!score) continue;
      match.mean += *score;
      ++structured;
    }
    match.mean /= std::max(structured, 1);
    match.structured = static_cast<double>(structured) / std::max(counted_, 1);
    match.worst = byPart_.empty() ? worstNeighbourhood() : worstPart();
    return match;
  }

 private:
  static std::optional<double> scoreOf(const cv::Mat& expected, const cv::Mat& seen,
                                       const cv::Rect& block, const Shifts& shifts) {
    const auto found = find(expected, seen, block, shifts);
    return found ? std::optional(found->agreement) : std::nullopt;
  }

  double worstPart() const {
    double worst = 1.0;
    for (const auto& [part, scores] : byPart_) {
      const double sum = std::accumulate(scores.begin(), scores.end(), 0.0);
      worst = std::min(worst, sum / static_cast<double>(scores.size()));
    }
    return worst;
  }

  double worstNeighbourhood() const {
    double worst = 1.0;
    for (int row = 0; row < down_; ++row) {
      for (int column = 0; column < across_; ++column) {
        if (const auto around = neighbourhood(row, column)) worst = std::min(worst, *around);
      }
    }
    return worst;
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
  std::map<std::size_t, std::vector<double>> byPart_;  // where there is relief
};

/// The match after the best shift of the whole. What shift the edges agree with depends on the
/// height that most of them have, so that several are tried.
StructureMatch bestMatch(const cv::Mat& expected, const cv::Mat& seen,
                         const StructureSearch& search) {
  const cv::Rect inner(kCoarseShiftPx, kCoarseShiftPx, expected.cols - 2 * kCoarseShiftPx,
                       expected.rows - 2 * kCoarseShiftPx);
  std::optional<StructureMatch> best;
  for (const double height : heightsOf(search.relief)) {
    const glm::dvec2 byHeight = height * search.reliefPx;
    const auto whole =
        find(expected, seen, inner, {.from = byHeight, .to = byHeight, .slack = kCoarseShiftPx});
    const glm::dvec2 around =
        whole ? glm::dvec2(whole->shift.x, whole->shift.y) - byHeight : glm::dvec2(0.0);
    const StructureMatch match = BlockGrid(expected, seen, search, around).match();
    if (!best || match.mean > best->mean) best = match;
  }
  return *best;
}

}  // namespace

StructureMatch matchStructure(const hal::ImageView& expected, const hal::ImageView& seen,
                              const StructureSearch& search) {
  assert(expected.format.size == seen.format.size && expected.format.size.width >= 64);
  const cv::Mat first = matrixOf(expected);
  const cv::Mat second = matrixOf(seen);
  cv::Mat looked = edgeDirections(first, kEdge);
  if (!search.relief.empty()) {
    looked.setTo(cv::Scalar(0.0, 0.0), placesBeside(search.relief, looked.size()));
  }
  StructureMatch match = bestMatch(looked, edgeDirections(second, kSeenEdge), search);
  match.brightness = cv::mean(second)[0];
  return match;
}

}  // namespace pleinair::inspection
