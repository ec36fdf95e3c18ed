#include "pipeline/tracking/image/homography.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <opencv2/calib3d.hpp>

namespace pleinair::tracking {

glm::dvec2 movedBy(const glm::dmat3& homography, const glm::dvec2& px) {
  const glm::dvec3 to = homography * glm::dvec3(px, 1.0);
  return glm::dvec2(to) / to.z;
}

double rmsMotion(const glm::dmat3& homography, hal::FrameSize size) {
  double sum = 0.0;
  double count = 0.0;
  forGridCentres(size, [&](const glm::dvec2& px) {
    const glm::dvec2 step = movedBy(homography, px) - px;
    sum += glm::dot(step, step);
    count += 1.0;
  });
  return std::sqrt(sum / count);
}

namespace {

constexpr std::size_t kMinPairs = 12;
constexpr double kMinAgreeingShare = 0.4;  // part of the pairs that must agree
/// The agreeing pairs must lie in at least this many cells of a grid over the image.
constexpr int kColumns = 4;
constexpr int kRows = 4;
constexpr int kMinCells = 6;
/// RANSAC's tolerance: a part of the image's longer side (1.3 px of 640), and at least this many
/// mean errors.
constexpr double kOutlierPart = 0.002;
constexpr double kOutlierErrors = 3.0;
constexpr int kSteps = 6;
/// Deviations larger than this many predicted errors, plus this part of RANSAC's tolerance, get
/// less weight.
constexpr double kRobustErrors = 3.0;
constexpr double kRobustPart = 0.15;

/// Maps px to coordinates of about ±1 around the image's centre.
struct Scaling {
  glm::dvec2 middle;
  double unit;
  explicit Scaling(hal::FrameSize size)
      : middle(size.width / 2.0, size.height / 2.0),
        unit(std::max(size.width, size.height) / 2.0) {}
  glm::dvec2 of(const glm::dvec2& px) const { return (px - middle) / unit; }
  glm::dmat3 matrix() const {
    return {1.0 / unit, 0.0, 0.0, 0.0, 1.0 / unit, 0.0, -middle.x / unit, -middle.y / unit, 1.0};
  }
};

/// Applies a homography given by its first eight entries, row by row; the ninth is 1.
glm::dvec2 apply(const cv::Vec<double, 8>& h, const glm::dvec2& p) {
  const double w = h[6] * p.x + h[7] * p.y + 1.0;
  return {(h[0] * p.x + h[1] * p.y + h[2]) / w, (h[3] * p.x + h[4] * p.y + h[5]) / w};
}

/// Derivatives of apply() by these entries: one row for x and one for y.
std::array<cv::Vec<double, 8>, 2> derivatives(const cv::Vec<double, 8>& h, const glm::dvec2& p) {
  const double w = h[6] * p.x + h[7] * p.y + 1.0;
  const glm::dvec2 to = apply(h, p);
  const double x = p.x / w;
  const double y = p.y / w;
  return {cv::Vec<double, 8>{x, y, 1.0 / w, 0.0, 0.0, 0.0, -x * to.x, -y * to.x},
          cv::Vec<double, 8>{0.0, 0.0, 0.0, x, y, 1.0 / w, -x * to.y, -y * to.y}};
}

cv::Vec<double, 8> numbersOf(const glm::dmat3& m) {
  const double s = 1.0 / m[2][2];  // glm indexes as m[column][row]
  return {m[0][0] * s, m[1][0] * s, m[2][0] * s, m[0][1] * s,
          m[1][1] * s, m[2][1] * s, m[0][2] * s, m[1][2] * s};
}

glm::dmat3 matrixOf(const cv::Vec<double, 8>& h) {
  return {h[0], h[3], h[6], h[1], h[4], h[7], h[2], h[5], 1.0};
}

/// Whether all image corners stay far from the horizon. No camera moves further in one frame.
bool isGentle(const cv::Vec<double, 8>& h) {
  constexpr double kMaxPerspective = 0.5;
  return std::abs(h[6]) + std::abs(h[7]) < kMaxPerspective;
}

}  // namespace

bool HomographyFitter::findAgreeing(std::span<const PointPair> pairs, hal::FrameSize size,
                                    glm::dmat3& start) {
  from_.clear();
  to_.clear();
  for (const PointPair& pair : pairs) {
    from_.emplace_back(static_cast<float>(pair.previous.x), static_cast<float>(pair.previous.y));
    to_.emplace_back(static_cast<float>(pair.current.x), static_cast<float>(pair.current.y));
  }
  double errorPx = 0.0;
  for (const PointPair& pair : pairs) errorPx += pair.errorPx / static_cast<double>(pairs.size());
  const double outlierPx =
      std::max(kOutlierPart * std::max(size.width, size.height), kOutlierErrors * errorPx);
  constexpr int kTries = 300;
  constexpr double kConfidence = 0.995;
  const cv::Mat found =
      cv::findHomography(from_, to_, cv::RANSAC, outlierPx, agrees_, kTries, kConfidence);
  if (found.empty()) return false;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) start[column][row] = found.at<double>(row, column);
  }
  return true;
}

bool HomographyFitter::coversEnough(std::span<const PointPair> pairs, hal::FrameSize size) const {
  std::array<bool, std::size_t{kColumns} * kRows> fields{};
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (agrees_[i] == 0) continue;
    const glm::dvec2 part = pairs[i].current / glm::dvec2(size.width, size.height);
    const int column = std::clamp(static_cast<int>(part.x * kColumns), 0, kColumns - 1);
    const int row = std::clamp(static_cast<int>(part.y * kRows), 0, kRows - 1);
    fields[static_cast<std::size_t>(row * kColumns + column)] = true;
  }
  return std::ranges::count(fields, true) >= kMinCells;
}

/// Sums of one step of weighted least squares.
struct HomographyFitter::Sums {
  Matrix8 normal = Matrix8::zeros();
  Vector8 right = Vector8::all(0.0);
  double squares = 0.0;   // sum of squared deviations, px²
  double expected = 0.0;  // the sum that the pairs' errors predict
  double weights = 0.0;
};

/// `excess`: the variance (px²) by which points deviate beyond their own errors.
HomographyFitter::Sums HomographyFitter::accumulate(std::span<const PointPair> pairs,
                                                    hal::FrameSize size, const Vector8& h,
                                                    double excess) const {
  const Scaling scaling(size);
  const double softPx = kRobustPart * kOutlierPart * std::max(size.width, size.height);
  Sums out;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (agrees_[i] == 0) continue;
    const glm::dvec2 p = scaling.of(pairs[i].previous);
    const glm::dvec2 residual = scaling.of(pairs[i].current) - apply(h, p);
    const double px = glm::length(residual) * scaling.unit;
    const double own = pairs[i].errorPx * pairs[i].errorPx;
    const double soft = kRobustErrors * std::sqrt(own + excess) + softPx;
    const double robust = 1.0 / (1.0 + px * px / (soft * soft));
    const double part = robust / (own + excess);
    const double weight = 2.0 * scaling.unit * scaling.unit * part;  // two axes share the error
    const auto by = derivatives(h, p);
    for (int axis = 0; axis < 2; ++axis) {
      const Vector8& row = by[static_cast<std::size_t>(axis)];
      out.right += weight * residual[axis] * row;
      out.normal += weight * (row * row.t());
    }
    out.squares += part * px * px;
    out.expected += part * own;
    out.weights += part;
  }
  return out;
}

std::optional<HomographyFit> HomographyFitter::refine(std::span<const PointPair> pairs,
                                                      hal::FrameSize size,
                                                      const glm::dmat3& start) const {
  const Scaling scaling(size);
  const glm::dmat3 toUnits = scaling.matrix();
  const glm::dmat3 toPx = glm::inverse(toUnits);
  Vector8 h = numbersOf(toUnits * start * toPx);
  Sums sums;
  double excess = 0.0;
  for (int step = 0; step < kSteps; ++step) {
    sums = accumulate(pairs, size, h, excess);
    Vector8 change;
    if (!cv::solve(sums.normal, sums.right, change, cv::DECOMP_CHOLESKY)) return std::nullopt;
    h += change;
    excess = std::max(0.0, (sums.squares - sums.expected) / sums.weights);
  }
  const Matrix8 covariance = sums.normal.inv(cv::DECOMP_CHOLESKY);
  double variance = 0.0;
  double places = 0.0;
  forGridCentres(size, [&](const glm::dvec2& px) {
    for (const Vector8& row : derivatives(h, scaling.of(px))) {
      variance += row.dot(covariance * row) * scaling.unit * scaling.unit;
    }
    places += 1.0;
  });
  HomographyFit out{.currentFromPrevious = toPx * matrixOf(h) * toUnits,
                    .fitErrorPx = std::sqrt(variance / places),
                    .modelErrorPx = std::sqrt(excess)};
  out.currentFromPrevious /= out.currentFromPrevious[2][2];
  if (!isGentle(h) || !std::isfinite(out.fitErrorPx)) return std::nullopt;
  return out;
}

std::optional<HomographyFit> HomographyFitter::fit(std::span<const PointPair> pairs,
                                                   hal::FrameSize size) {
  agrees_.assign(pairs.size(), 0);
  glm::dmat3 start(1.0);
  if (pairs.size() < kMinPairs || !findAgreeing(pairs, size, start)) return std::nullopt;
  const auto agreeing = static_cast<std::size_t>(std::ranges::count(agrees_, 1));
  if (agreeing < kMinPairs ||
      static_cast<double>(agreeing) < kMinAgreeingShare * static_cast<double>(pairs.size()) ||
      !coversEnough(pairs, size)) {
    return std::nullopt;
  }
  auto fit = refine(pairs, size, start);
  if (fit) fit->agreeing = agreeing;
  return fit;
}

}  // namespace pleinair::tracking
