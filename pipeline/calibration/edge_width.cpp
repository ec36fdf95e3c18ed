#include "pipeline/calibration/edge_width.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <glm/geometric.hpp>

#include "pipeline/calibration/grey_at.h"

namespace pleinair::calibration {
namespace {

constexpr double kMinContrast = 12.0;  // grey levels
constexpr double kMaxReachPx = 10.0;
constexpr double kMinReachPx = 3.0;  // a blur wider than the reach would look sharp
constexpr int kStepsPerPx = 4;

/// The width of one edge, from the mean profile across its middle fifth.
std::optional<double> widthOf(const hal::PlaneView& luma, hal::FrameSize size, const glm::dvec2& a,
                              const glm::dvec2& b, double clearance) {
  constexpr int kLines = 7;
  const glm::dvec2 along = b - a;
  const double length = glm::length(along);
  const double reach = std::min(clearance * length, kMaxReachPx);
  if (reach < kMinReachPx) return std::nullopt;
  const glm::dvec2 across(-along.y / length, along.x / length);
  const glm::dvec2 middle = (a + b) / 2.0;
  const double room = reach + 0.1 * length + 2.0;
  if (middle.x < room || middle.y < room || middle.x > size.width - room ||
      middle.y > size.height - room) {
    return std::nullopt;
  }
  const int steps = static_cast<int>(2.0 * reach * kStepsPerPx);
  std::vector<double> profile;
  for (int step = 0; step <= steps; ++step) {
    const glm::dvec2 at = middle + across * (static_cast<double>(step) / kStepsPerPx - reach);
    double sum = 0.0;
    for (int line = 0; line < kLines; ++line) {
      sum += greyAt(luma, at + along * (0.2 * (line / (kLines - 1.0) - 0.5)));
    }
    profile.push_back(sum / kLines);
  }
  const double contrast = std::abs(profile.back() - profile.front());
  if (contrast < kMinContrast) return std::nullopt;
  double steepest = 0.0;  // grey levels per pixel, over one pixel
  for (std::size_t i = kStepsPerPx; i < profile.size(); ++i) {
    steepest = std::max(steepest, std::abs(profile[i] - profile[i - kStepsPerPx]));
  }
  return contrast / steepest;
}

std::optional<double> median(std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

std::optional<double> edgeWidth(const hal::PlaneView& luma, hal::FrameSize size, const Board& board,
                                std::span<const SightedCorner> corners) {
  std::vector<const SightedCorner*> byId(board.corners().size(), nullptr);
  for (const SightedCorner& corner : corners) byId[static_cast<std::size_t>(corner.id)] = &corner;
  std::array<std::vector<double>, 2> widths;
  for (const BoardEdge& edge : board.edges()) {
    const SightedCorner* from = byId[static_cast<std::size_t>(edge.from)];
    const SightedCorner* to = byId[static_cast<std::size_t>(edge.to)];
    if (from == nullptr || to == nullptr) continue;
    if (const auto width = widthOf(luma, size, from->px, to->px, edge.clearance)) {
      widths[edge.isAlongX ? 1 : 0].push_back(*width);
    }
  }
  const std::optional<double> one = median(widths[0]);
  const std::optional<double> other = median(widths[1]);
  if (!one || !other) return one ? one : other;
  return std::max(*one, *other);
}

}  // namespace pleinair::calibration
