#include "pipeline/tracking/segments/image_segmenter.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/common.hpp>
#include <glm/mat3x3.hpp>

#include "pipeline/tracking/segments/cell_colours.h"
#include "pipeline/tracking/segments/segment_merging.h"

namespace pleinair::tracking {
namespace {

constexpr double kLeastStepPx = 2.0;
constexpr float kHeldNoises =
    12.0F;  // of a cell; as a distance, noise is 2.5 standard deviations long
constexpr float kHeldLevels = 3.0F;  // of colour, beyond them
/// Frames without a change after which the labels rest: hysteresis has settled.
constexpr int kSettledFrames = 24;
constexpr int kLeastOverlap = 3;
/// A new segment is shown once it has been found in so many frames: till then, its cells count as
/// what they were.
constexpr std::uint8_t kMatureFrames = 12;
/// A cell becomes unsure, or sure again, after so many frames.
constexpr std::uint8_t kDoubtFrames = 8;
constexpr float kGoodFlowPx = 1.5F;
constexpr float kUsableFlowPx = 4.0F;

std::size_t indexOf(int i) {
  return static_cast<std::size_t>(i);
}

hal::FrameSize gridOf(hal::FrameSize size) {
  const double step =
      std::max(kLeastStepPx,
               static_cast<double>(std::max(size.width, size.height)) / ImageSegmenter::kLongSide);
  const auto cells = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(side / step)));
  };
  return {cells(size.width), cells(size.height)};
}

bool isStandingStill(const ImageMotion& motion) {
  return motion.picture && motion.picture->currentFromPrevious == glm::dmat3(1.0);
}

const glm::vec4* nodeAt(const DenseFlow& flow, const glm::dvec2& px) {
  if (flow.nodes.width == 0 || flow.backward.empty()) return nullptr;
  const glm::ivec2 last(flow.nodes.width - 1, flow.nodes.height - 1);
  const glm::ivec2 node = glm::clamp(glm::ivec2(px / glm::dvec2(flow.stepPx)), glm::ivec2(0), last);
  return &flow.backward[indexOf(node.y * flow.nodes.width + node.x)];
}

/// Where the content at px was in the previous frame; outside of the image where nobody knows.
glm::dvec2 placeBefore(const ImageMotion& motion, const glm::dmat3& previousFromCurrent,
                       const glm::dvec2& px) {
  const glm::vec4* const node = nodeAt(motion.flow, px);
  if (node != nullptr && node->z < (motion.picture ? kGoodFlowPx : kUsableFlowPx)) {
    return px + glm::dvec2(node->x, node->y);
  }
  if (!motion.picture) return glm::dvec2(-1.0);
  const glm::dvec3 p = previousFromCurrent * glm::dvec3(px, 1.0);
  return glm::dvec2(p) / p.z;
}

std::uint8_t levelOf(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

}  // namespace

struct ImageSegmenter::State {
  struct Overlap {
    int segment;
    std::uint16_t label;
    int cells;
  };

  bool takeColours(bool isStanding, double noiseLevels);
  glm::dvec2 cellPx() const;
  void carry(const ImageMotion& motion, bool isStanding);
  void assignLabels();
  std::uint16_t newLabel();
  void showMature();
  void smoothColours();

  hal::FrameSize frameSize;
  hal::FrameSize grid;
  bool hasPast = false;
  int unchangedFrames = 0;
  CellColours reduced;
  std::vector<CellColour> colours;  // held
  SegmentMerger merger;
  std::vector<std::uint16_t> carried;  // of `found`
  std::vector<std::uint16_t> shown;    // what the carried labels were shown as
  std::vector<std::uint8_t> waited;    // frames since the carried cell should be unsure, or sure
  std::vector<std::uint8_t> waiting;   // the same of this frame
  std::vector<std::uint16_t> found;    // labels of this frame, young ones, too
  std::array<std::uint8_t, kMaxSegmentLabel + 1> ages{};  // frames, up to kMatureFrames
  std::vector<std::uint32_t> pairs;                       // segment and carried label of each cell
  std::vector<Overlap> overlaps;
  std::vector<std::uint16_t> labels;  // of the segments
  std::array<bool, kMaxSegmentLabel + 1> isUsed{};
  std::uint16_t lastLabel = 0;
  std::vector<SegmentCell> cells;
  std::vector<bool> isCore;
  ImageSegments segments;
};

ImageSegmenter::ImageSegmenter() : state_(std::make_unique<State>()) {}

ImageSegmenter::~ImageSegmenter() = default;

void ImageSegmenter::reset() {
  state_->hasPast = false;
}

glm::dvec2 ImageSegmenter::State::cellPx() const {
  return glm::dvec2(frameSize.width, frameSize.height) / glm::dvec2(grid.width, grid.height);
}

/// Whether any colour has changed.
bool ImageSegmenter::State::takeColours(bool isStanding, double noiseLevels) {
  const std::vector<CellColour>& now = reduced.colours();
  const glm::dvec2 side = cellPx();
  const auto noise = static_cast<float>(noiseLevels / std::sqrt(side.x * side.y));
  const float slack = kHeldLevels + kHeldNoises * noise;
  bool hasChanged = false;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (isStanding && distanceOf(now[i], colours[i]) < slack) continue;
    colours[i] = now[i];
    hasChanged = true;
  }
  return hasChanged;
}

/// The labels of the previous frame at the places where the cells' contents were.
void ImageSegmenter::State::carry(const ImageMotion& motion, bool isStanding) {
  if (!hasPast) {
    std::ranges::fill(carried, std::uint16_t{0});
    std::ranges::fill(shown, std::uint16_t{0});
    std::ranges::fill(waited, kDoubtFrames);
    return;
  }
  const glm::dvec2 side = cellPx();
  const glm::dmat3 previousFromCurrent =
      motion.picture ? glm::inverse(motion.picture->currentFromPrevious) : glm::dmat3(1.0);
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const glm::dvec2 px = (glm::dvec2(x, y) + 0.5) * side;
      const glm::dvec2 from = isStanding ? px : placeBefore(motion, previousFromCurrent, px);
      const glm::ivec2 cell(glm::floor(from / side));
      const bool isThere =
          cell.x >= 0 && cell.y >= 0 && cell.x < grid.width && cell.y < grid.height;
      const std::size_t to = indexOf(y * grid.width + x);
      const std::size_t at = isThere ? indexOf(cell.y * grid.width + cell.x) : 0;
      carried[to] = isThere ? found[at] : std::uint16_t{0};
      shown[to] = isThere ? cells[at].label : std::uint16_t{0};
      waited[to] = isThere ? waiting[at] : kDoubtFrames;  // what comes to sight does not wait
    }
  }
}

std::uint16_t ImageSegmenter::State::newLabel() {
  for (int tries = 0; tries < kMaxSegmentLabel; ++tries) {
    lastLabel = static_cast<std::uint16_t>(lastLabel % kMaxSegmentLabel + 1);
    if (!isUsed.at(lastLabel)) return lastLabel;
  }
  return 0;  // as good as unsure
}

/// Each segment takes the label that most of it had, unless more of another one had it.
void ImageSegmenter::State::assignLabels() {
  constexpr unsigned kLabelBits = 16;
  const std::span<const int> segmentOf = merger.segments();
  pairs.clear();
  for (std::size_t i = 0; i < segmentOf.size(); ++i) {
    if (segmentOf[i] == SegmentMerger::kUnsure || carried[i] == 0) continue;
    pairs.push_back(static_cast<std::uint32_t>(segmentOf[i]) << kLabelBits | carried[i]);
  }
  std::ranges::sort(pairs);
  overlaps.clear();
  for (std::size_t i = 0; i < pairs.size();) {
    std::size_t end = i;
    while (end < pairs.size() && pairs[end] == pairs[i]) ++end;
    overlaps.push_back({static_cast<int>(pairs[i] >> kLabelBits),
                        static_cast<std::uint16_t>(pairs[i] & 0xFFFFU), static_cast<int>(end - i)});
    i = end;
  }
  std::ranges::sort(overlaps, [](const Overlap& a, const Overlap& b) {
    if (a.cells != b.cells) return a.cells > b.cells;
    return a.segment != b.segment ? a.segment < b.segment : a.label < b.label;
  });
  labels.assign(indexOf(merger.count()), 0);
  isUsed.fill(false);
  for (const Overlap& each : overlaps) {
    std::uint16_t& label = labels[indexOf(each.segment)];
    if (label != 0 || isUsed.at(each.label) || each.cells < kLeastOverlap) continue;
    label = each.label;
    isUsed.at(label) = true;
  }
  for (std::uint16_t& label : labels) {
    if (label != 0) continue;
    label = newLabel();
    isUsed.at(label) = true;
    ages.at(label) = hasPast ? 0 : kMatureFrames;
  }
  for (std::size_t i = 0; i < segmentOf.size(); ++i) {
    found[i] =
        segmentOf[i] == SegmentMerger::kUnsure ? std::uint16_t{0} : labels[indexOf(segmentOf[i])];
  }
}

/// Young segments are not shown yet: each of their cells is what it was, or else unsure. So is for
/// a while what has lost its segment or got one.
void ImageSegmenter::State::showMature() {
  for (const std::uint16_t label : labels) {
    ages.at(label) = std::min<std::uint8_t>(kMatureFrames, ages.at(label) + 1U);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const bool isYoung = found[i] != 0 && ages.at(found[i]) < kMatureFrames;
    const std::uint16_t label = isYoung ? shown[i] : found[i];
    const bool isDoubtful = (label == 0) != (shown[i] == 0);
    const bool isLate = isDoubtful && waited[i] < kDoubtFrames;
    waiting[i] = isLate ? static_cast<std::uint8_t>(waited[i] + 1U) : std::uint8_t{0};
    cells[i].label = isLate ? shown[i] : label;
  }
}

/// Near borders, a segment's colour is that of its cells that are not at the border.
void ImageSegmenter::State::smoothColours() {
  constexpr int kReach = 2;
  const auto labelAt = [this](int x, int y) { return cells[indexOf(y * grid.width + x)].label; };
  const auto isUniform = [&](int x, int y, int reach) {
    const std::uint16_t own = labelAt(x, y);
    for (int v = std::max(0, y - reach); v <= std::min(grid.height - 1, y + reach); ++v) {
      for (int u = std::max(0, x - reach); u <= std::min(grid.width - 1, x + reach); ++u) {
        if (labelAt(u, v) != own) return false;
      }
    }
    return true;
  };
  isCore.resize(cells.size());
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t i = indexOf(y * grid.width + x);
      isCore[i] = isUniform(x, y, 1);
      cells[i].isInside = isCore[i] && isUniform(x, y, kReach);
    }
  }
  for (int y = 0; y < grid.height; ++y) {
    for (int x = 0; x < grid.width; ++x) {
      const std::size_t i = indexOf(y * grid.width + x);
      CellColour sum;
      float weights = 0.0F;
      const int reach = cells[i].isInside ? 0 : kReach;
      for (int v = std::max(0, y - reach); v <= std::min(grid.height - 1, y + reach); ++v) {
        for (int u = std::max(0, x - reach); u <= std::min(grid.width - 1, x + reach); ++u) {
          const std::size_t there = indexOf(v * grid.width + u);
          if (cells[there].label != cells[i].label) continue;
          const float weight = isCore[there] ? 1.0F : 0.05F;
          sum.luma += weight * colours[there].luma;
          sum.cb += weight * colours[there].cb;
          sum.cr += weight * colours[there].cr;
          weights += weight;
        }
      }
      constexpr float kChromaZero = 128.0F;
      cells[i].luma = levelOf(sum.luma / weights);
      cells[i].cb = levelOf(kChromaZero + sum.cb / weights);
      cells[i].cr = levelOf(kChromaZero + sum.cr / weights);
    }
  }
}

const ImageSegments& ImageSegmenter::follow(const hal::ImageView& image,
                                            const ImageMotion& motion) {
  State& s = *state_;
  if (motion.isCut || s.frameSize != image.format.size) s.hasPast = false;
  s.frameSize = image.format.size;
  s.grid = gridOf(s.frameSize);
  const auto count = static_cast<std::size_t>(s.grid.pixels());
  s.colours.resize(count);
  s.carried.resize(count);
  s.shown.resize(count);
  s.waited.resize(count);
  s.waiting.resize(count);
  s.found.resize(count);
  s.cells.resize(count);
  s.pairs.reserve(count);
  s.overlaps.reserve(count);
  s.labels.reserve(count);
  s.reduced.reduce(image, s.grid);
  const bool isStanding = s.hasPast && isStandingStill(motion);
  const bool hasChanged = s.takeColours(isStanding, motion.noiseLevels);
  s.unchangedFrames = hasChanged ? 0 : s.unchangedFrames + 1;
  if (s.unchangedFrames < kSettledFrames) {
    s.carry(motion, isStanding);
    s.merger.merge(s.grid, s.colours, s.carried);
    s.assignLabels();
    s.showMature();
    s.smoothColours();
  }
  s.hasPast = true;
  s.segments = {.frameSize = s.frameSize, .grid = s.grid, .cells = s.cells};
  return s.segments;
}

}  // namespace pleinair::tracking
