#include "pipeline/tracking/motion/view_comparison.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "pipeline/tracking/image/luma_pyramid.h"
#include "pipeline/tracking/image/parallel_loop.h"
#include "pipeline/tracking/motion/image_motion.h"

namespace pleinair::tracking {
namespace {

constexpr int kLongSidePx = 112;
constexpr int kBlockPx = 10;
constexpr double kReachPart = 0.3;  // of each side: shifts that are searched
/// Smaller eigenvalue of the structure tensor (levels²) of a block with texture, and how much more
/// it takes for each unit of the noise's variance.
constexpr double kMinTexture = 1.0;
constexpr double kNoiseTexture = 4.0;
constexpr int kMinReduction = 4;  // of a frame; lower, noise would be texture
constexpr double kAlike = 0.6;    // correlation of a block that is seen again
/// Blocks move together if they are this close to one similarity, whose zoom and turn are limited
/// to what a camera does between two frames.
constexpr double kTogetherPx = 1.8;
constexpr double kMaxZoom = 1.3;
constexpr double kMaxTurnRad = 0.35;
constexpr double kMinApartPx = 15.0;  // of two blocks that determine a similarity

/// Smaller eigenvalue of a block's mean structure tensor.
double textureOf(const cv::Mat& picture, const cv::Rect& block) {
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (int y = block.y; y < block.y + block.height - 1; ++y) {
    const auto* const row = picture.ptr<unsigned char>(y);
    const auto* const below = picture.ptr<unsigned char>(y + 1);
    for (int x = block.x; x < block.x + block.width - 1; ++x) {
      const double dx = row[x + 1] - row[x];
      const double dy = below[x] - row[x];
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  }
  const double count = (block.width - 1) * (block.height - 1);
  return (0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy)) / count;
}

}  // namespace

void ViewComparison::View::load(const LumaPyramid& pyramid) {
  const auto longSide = [](cv::Size size) { return std::max(size.width, size.height); };
  const cv::Mat& level =
      pyramid.smallest([&](cv::Size size) { return longSide(size) >= kLongSidePx; });
  const int whole = longSide(pyramid.picture().size());
  const int wanted = std::min(kLongSidePx, whole / kMinReduction);
  const double scale = std::min(1.0, static_cast<double>(wanted) / longSide(level.size()));
  const cv::Size size(std::max(1, static_cast<int>(std::lround(scale * level.cols))),
                      std::max(1, static_cast<int>(std::lround(scale * level.rows))));
  cv::resize(level, picture_, size, 0.0, 0.0, cv::INTER_AREA);
  // Fine texture would not match at shifts by half a pixel.
  constexpr double kSigmaPx = 0.7;
  cv::GaussianBlur(picture_, picture_, {3, 3}, kSigmaPx);
  reduction_ = static_cast<double>(whole) / longSide(size);
}

void ViewComparison::match(Block& block, const cv::Mat& before, const cv::Mat& after,
                           double minTexture) {
  const cv::Rect all(0, 0, before.cols, before.rows);
  const cv::Rect from(static_cast<int>(block.before.x), static_cast<int>(block.before.y), kBlockPx,
                      kBlockPx);
  block.isTextured = textureOf(before, from) > minTexture;
  block.correlation = 0.0;
  if (!block.isTextured) return;
  const cv::Point reach(static_cast<int>(kReachPart * before.cols),
                        static_cast<int>(kReachPart * before.rows));
  const cv::Rect where = cv::Rect(from.tl() - reach, from.br() + reach) & all;
  cv::Mat correlations;
  cv::matchTemplate(after(where), before(from), correlations, cv::TM_CCOEFF_NORMED);
  cv::Point best;
  cv::minMaxLoc(correlations, nullptr, &block.correlation, nullptr, &best);
  block.after = {where.x + best.x, where.y + best.y};
  // At the end of the search there is no maximum: the place may be beyond it.
  const bool isAtEnd = (best.x == 0 && where.x > 0) || (best.y == 0 && where.y > 0) ||
                       (best.x == correlations.cols - 1 && where.br().x < all.width) ||
                       (best.y == correlations.rows - 1 && where.br().y < all.height);
  if (isAtEnd) block.correlation = 0.0;
}

/// The most blocks that move by one similarity. Tries those of all single blocks, without zoom and
/// turn, and of all pairs: nothing is random.
std::size_t ViewComparison::agreeing() const {
  std::size_t most = 0;
  const auto count = [&](const PlaneSimilarity& motion) {
    std::size_t found = 0;
    for (const Block& block : blocks_) {
      const glm::dvec2 off = motion(block.before) - block.after;
      found += glm::dot(off, off) < kTogetherPx * kTogetherPx ? 1U : 0U;
    }
    most = std::max(most, found);
  };
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    const Block& a = blocks_[i];
    count({.linear = {1.0, 0.0}, .shift = a.after - a.before});
    for (std::size_t j = i + 1; j < blocks_.size(); ++j) {
      const Block& b = blocks_[j];
      const glm::dvec2 apart = b.before - a.before;
      const double squared = glm::dot(apart, apart);
      if (squared < kMinApartPx * kMinApartPx) continue;
      PlaneSimilarity motion;
      motion.linear = PlaneSimilarity::product(b.after - a.after, {apart.x, -apart.y}) / squared;
      const double zoom = motion.scale();
      if (zoom > kMaxZoom || zoom * kMaxZoom < 1.0 || std::abs(motion.angleRad()) > kMaxTurnRad)
        continue;
      motion.shift = a.after - PlaneSimilarity::product(motion.linear, a.before);
      count(motion);
    }
  }
  return most;
}

ViewComparison::Result ViewComparison::compare(const View& before, const View& after,
                                               double noise) {
  const cv::Mat& from = before.picture();
  const double reduced = noise / before.reduction();
  const double minTexture = kMinTexture + kNoiseTexture * reduced * reduced;
  blocks_.clear();
  if (from.size() != after.picture().size()) return {};
  for (int y = 0; y + kBlockPx <= from.rows; y += kBlockPx) {
    for (int x = 0; x + kBlockPx <= from.cols; x += kBlockPx) {
      blocks_.push_back({.before = {x, y}});
    }
  }
  parallelFor(static_cast<int>(blocks_.size()), [&](int i) {
    match(blocks_[static_cast<std::size_t>(i)], from, after.picture(), minTexture);
  });
  const auto textured =
      static_cast<std::size_t>(std::ranges::count_if(blocks_, &Block::isTextured));
  std::erase_if(blocks_, [](const Block& block) { return block.correlation < kAlike; });
  constexpr std::size_t kFree = 2;  // blocks that determine a similarity
  const std::size_t found = agreeing();
  if (textured <= kFree || found <= kFree) return {.textured = textured};
  return {.textured = textured,
          .sharedPart = static_cast<double>(found - kFree) / static_cast<double>(textured - kFree)};
}

}  // namespace pleinair::tracking
