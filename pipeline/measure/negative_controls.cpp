#include "pipeline/measure/negative_controls.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

#include <fmt/format.h>
#include <opencv2/core.hpp>

#include "pipeline/measure/input/picture.h"

namespace pleinair::measure {
namespace {

constexpr int kTilePixels = 8;

}  // namespace

VoronoiTiling::VoronoiTiling(cv::Size size, std::uint64_t seed) : tiles_(size) {
  const int columns = (size.width + kTilePixels - 1) / kTilePixels;
  const int rows = (size.height + kTilePixels - 1) / kTilePixels;
  count_ = columns * rows;
  // Sequences of neighbouring seeds would begin alike.
  constexpr std::uint64_t kSpread = 0x9E3779B97F4A7C15U;
  cv::RNG random((seed + 1) * kSpread);
  std::vector<cv::Point2f> seeds;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float x = random.uniform(0.0F, static_cast<float>(kTilePixels));
      const float y = random.uniform(0.0F, static_cast<float>(kTilePixels));
      seeds.emplace_back(static_cast<float>(column * kTilePixels) + x,
                         static_cast<float>(row * kTilePixels) + y);
    }
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const cv::Point2f centre(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
      // The seed of a pixel's own square is within the square's diagonal: no seed further than two
      // squares away is nearer.
      const int column = x / kTilePixels;
      const int row = y / kTilePixels;
      float nearest = std::numeric_limits<float>::infinity();
      for (int r = std::max(row - 2, 0); r <= std::min(row + 2, rows - 1); ++r) {
        for (int c = std::max(column - 2, 0); c <= std::min(column + 2, columns - 1); ++c) {
          const int index = r * columns + c;
          const cv::Point2f to = seeds[static_cast<std::size_t>(index)] - centre;
          const float distance = to.dot(to);
          if (distance >= nearest) continue;
          nearest = distance;
          tiles_(y, x) = index;
        }
      }
    }
  }
}

cv::Mat3f VoronoiTiling::paint(const cv::Mat3f& picture) const {
  assert(picture.size() == tiles_.size());
  std::vector<cv::Vec4f> sums(static_cast<std::size_t>(count_), cv::Vec4f());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec3f& color = picture(y, x);
      sums[static_cast<std::size_t>(tiles_(y, x))] += cv::Vec4f(color[0], color[1], color[2], 1);
    }
  }
  cv::Mat3f painted(picture.size());
  for (int y = 0; y < picture.rows; ++y) {
    for (int x = 0; x < picture.cols; ++x) {
      const cv::Vec4f& sum = sums[static_cast<std::size_t>(tiles_(y, x))];
      painted(y, x) = cv::Vec3f(sum[0], sum[1], sum[2]) * (1.0F / sum[3]);
    }
  }
  return painted;
}

namespace {

using State = Verdict::State;

constexpr std::uint64_t kFixedSeed = 0;
constexpr double kMinScreenPattern = 0.25;
/// Images carried along the true motion read up to 0.1, those under a wrong motion 0.8 and more.
constexpr double kMaxInputError = 0.5;
constexpr double kMinDisplacedXEw2 = 2;
/// Below this, in levels, tiles are hardly visible and cannot be told apart.
constexpr double kSmoothDeviation = 3.0;

/// Gates for marks that are redrawn in each frame, where the style has no gates of its own.
constexpr std::array kReferenceGates{
    styles::CoherenceGate{styles::CoherenceMeasure::kNHw2, styles::CoherenceGate::Side::kMax, 0.2},
    styles::CoherenceGate{styles::CoherenceMeasure::kXFlk, styles::CoherenceGate::Side::kMax, 0.5},
    styles::CoherenceGate{styles::CoherenceMeasure::kPop, styles::CoherenceGate::Side::kMax, 1,
                          false, styles::GateMotion::kPan},
};

/// Why a control may read wrong although the measures are valid.
std::string likelyCause(const PerSubject<Measures>& measures) {
  const std::optional<double>& deviation = measures[Subject::kFixed].dep;
  if (deviation && *deviation < kSmoothDeviation) {
    return fmt::format("; the input is too smooth: tiles of it differ from it by {:.1f} levels",
                       *deviation);
  }
  return "";
}

/// Under a motion other than that of the images, even the input does not match. (xEW2 of the input
/// is a number divided by itself and proves nothing.)
Verdict motionVerdict(const PerSubject<Measures>& measures) {
  Verdict verdict{
      .what = fmt::format("the input follows the given motion: nHW2 ≤ {:g}", kMaxInputError)};
  const std::optional<double>& carried = measures[Subject::kInput].nHw2;
  verdict.comparison = {.value = carried, .limit = kMaxInputError, .isUpperLimit = true};
  if (!carried) {
    verdict.found = "nothing to compare along a true motion";
    return verdict;
  }
  const bool isPassed = *carried <= kMaxInputError;
  verdict.state = isPassed ? State::kPassed : State::kFailed;
  verdict.found = fmt::format("{:.3f}", *carried);
  if (isPassed) return verdict;
  const std::string smooth = likelyCause(measures);
  verdict.found += smooth.empty() ? "; the motion is another, or noise hides it" : smooth;
  return verdict;
}

/// A displacement by less than a mark's size must show.
Verdict displacedVerdict(const PerSubject<Measures>& measures,
                         const std::optional<double>& displacedXEw2) {
  Verdict verdict{.what = fmt::format("the input displaced by 2 px against it reads xEW2 > {:g}",
                                      kMinDisplacedXEw2),
                  .found = "nothing to compare along a true motion"};
  verdict.comparison = {.value = displacedXEw2, .limit = kMinDisplacedXEw2, .isUpperLimit = false};
  if (!displacedXEw2) return verdict;
  const bool isPassed = *displacedXEw2 > kMinDisplacedXEw2;
  verdict.state = isPassed ? State::kPassed : State::kFailed;
  verdict.found = fmt::format("{:.3g}", *displacedXEw2) + (isPassed ? "" : likelyCause(measures));
  return verdict;
}

/// Whether a gate is on a measure of coherence: only these have to stop marks that are redrawn each
/// frame. DEP, DET and SCR compare single pictures, and fail for other reasons.
bool isOfCoherence(const Verdict& gate) {
  return gate.what.starts_with("nHW2 ") || gate.what.starts_with("xFLK ") ||
         gate.what.starts_with("POP ");
}

Verdict freshVerdict(const PerSubject<Measures>& measures, const styles::CoherenceGates& gates,
                     const RunConditions& runConditions) {
  Verdict verdict{.what = "marks redrawn each frame fail the gates of coherence"};
  bool isMeasured = false;
  for (const Verdict& gate :
       gateVerdicts(gates, runConditions, measures[Subject::kFresh], measures[Subject::kFixed])) {
    if (!isOfCoherence(gate)) continue;
    isMeasured |= gate.state != State::kNotMeasured;
    if (gate.state != State::kFailed) continue;
    verdict.state = State::kPassed;
    verdict.found +=
        fmt::format("{}{} fails with {}", verdict.found.empty() ? "" : ", ", gate.what, gate.found);
  }
  if (verdict.state == State::kPassed) return verdict;
  verdict.state = isMeasured ? State::kFailed : State::kNotMeasured;
  verdict.found =
      (isMeasured ? "they pass" : "none of these could be measured") + likelyCause(measures);
  return verdict;
}

Verdict fixedVerdict(const PerSubject<Measures>& measures, const RunConditions& runConditions) {
  Verdict verdict{.what =
                      fmt::format("marks fixed to the screen read SCR ≥ {:g}", kMinScreenPattern)};
  const std::optional<double>& screen = measures[Subject::kFixed].scr;
  verdict.comparison = {.value = screen, .limit = kMinScreenPattern, .isUpperLimit = false};
  if (!screen) {
    verdict.found = "SCR: " + reasonMissing(&Measures::scr, runConditions);
    return verdict;
  }
  const bool isPassed = *screen >= kMinScreenPattern;
  verdict.state = isPassed ? State::kPassed : State::kFailed;
  verdict.found = fmt::format("{:.3f}", *screen) + (isPassed ? "" : likelyCause(measures));
  return verdict;
}

/// Rounds to whole levels, as in every painting.
cv::Mat3f inLevels(const cv::Mat3f& picture) {
  return toFloat(toImage(picture).view());
}

}  // namespace

ControlPainter::ControlPainter(cv::Size size) : fixed_(size, kFixedSeed) {}

PerSubject<cv::Mat3f> ControlPainter::paint(const cv::Mat3f& input, const cv::Mat3f& output,
                                            std::uint64_t index) const {
  PerSubject<cv::Mat3f> pictures;
  pictures[Subject::kPainting] = output;
  pictures[Subject::kInput] = input;
  pictures[Subject::kFresh] =
      inLevels(VoronoiTiling(input.size(), kFixedSeed + 1 + index).paint(input));
  pictures[Subject::kFixed] = inLevels(fixed_.paint(input));
  return pictures;
}

std::vector<Verdict> controlVerdicts(const PerSubject<Measures>& measures,
                                     const styles::CoherenceGates& gates,
                                     const RunConditions& runConditions,
                                     const std::optional<double>& displacedXEw2) {
  const styles::CoherenceGates judged =
      gates.empty() ? styles::CoherenceGates{kReferenceGates} : gates;
  return {motionVerdict(measures), freshVerdict(measures, judged, runConditions),
          fixedVerdict(measures, runConditions), displacedVerdict(measures, displacedXEw2)};
}

}  // namespace pleinair::measure
