#include "pipeline/tracking/segments/segment_merging.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

namespace pleinair::tracking {
namespace {

constexpr int kMaxWeight = 127;  // levels of colour; cells further apart are not merged by means
constexpr float kAlikeMeans = 22.0F;  // levels of colour
constexpr float kSmallSlack = 2.0F;   // cells: by what small regions may be less alike
constexpr float kClearBorder = 40.0F;
constexpr float kTexture = 2.0F;  // times the contrast within both segments
constexpr float kHold = 0.45F;    // hysteresis, as a part
constexpr int kLeastCells = 40;
constexpr int kLeastCores = 10;
constexpr int kRounds = 3;
constexpr int kLargestSpeck = 24;  // cells that are filled; larger gaps lose their rim only

float biasOf(std::uint16_t first, std::uint16_t second) {
  if (first == 0 || second == 0) return 1.0F;
  return first == second ? 1.0F + kHold : 1.0F - kHold;
}

std::size_t indexOf(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace

template <class Body>
void SegmentMerger::forNeighbours(int cell, const Body& body) const {
  const int x = cell % grid_.width;
  if (x > 0) body(cell - 1);
  if (x + 1 < grid_.width) body(cell + 1);
  if (cell >= grid_.width) body(cell - grid_.width);
  if (cell + grid_.width < static_cast<int>(segments_.size())) body(cell + grid_.width);
}

int SegmentMerger::rootOf(int cell) {
  while (parents_[indexOf(cell)] != cell) {
    int& parent = parents_[indexOf(cell)];
    parent = parents_[indexOf(parent)];
    cell = parent;
  }
  return cell;
}

void SegmentMerger::join(int first, int second) {
  Region& a = regions_[indexOf(first)];
  Region& b = regions_[indexOf(second)];
  const bool isFirst = a.cells > b.cells || (a.cells == b.cells && first < second);
  Region& larger = isFirst ? a : b;
  const Region& smaller = isFirst ? b : a;
  parents_[indexOf(isFirst ? second : first)] = isFirst ? first : second;
  const auto part =
      static_cast<float>(larger.cells) / static_cast<float>(larger.cells + smaller.cells);
  larger.texture = part * larger.texture + (1.0F - part) * smaller.texture;
  larger.luma += smaller.luma;
  larger.cb += smaller.cb;
  larger.cr += smaller.cr;
  larger.cells += smaller.cells;
  if (larger.label == 0) larger.label = smaller.label;
}

/// Neighbouring cells by their difference, with hysteresis; a counting sort, which is stable.
void SegmentMerger::sortEdges() {
  edges_.clear();
  weights_.clear();
  bins_.assign(kMaxWeight + 2, 0);
  const auto add = [this](int first, int second) {
    const std::uint16_t one = carried_[indexOf(first)];
    const std::uint16_t other = carried_[indexOf(second)];
    const float apart = distanceOf(colours_[indexOf(first)], colours_[indexOf(second)]);
    const auto weight = static_cast<int>(apart / biasOf(one, other));
    if (weight > kMaxWeight) return;
    edges_.push_back({first, second});
    weights_.push_back(static_cast<std::uint16_t>(weight));
    ++bins_[indexOf(weight) + 1];
  };
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      const int cell = y * grid_.width + x;
      if (x + 1 < grid_.width) add(cell, cell + 1);
      if (y + 1 < grid_.height) add(cell, cell + grid_.width);
    }
  }
  std::partial_sum(bins_.begin(), bins_.end(), bins_.begin());
  sorted_.resize(edges_.size());
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    sorted_[indexOf(bins_[weights_[i]]++)] = edges_[i];
  }
}

void SegmentMerger::mergeByMeans() {
  for (const Edge& edge : sorted_) {
    const int first = rootOf(edge.first);
    const int second = rootOf(edge.second);
    if (first == second) continue;
    const Region& a = regions_[indexOf(first)];
    const Region& b = regions_[indexOf(second)];
    const auto smaller = static_cast<float>(std::min(a.cells, b.cells));
    const float limit = kAlikeMeans * biasOf(a.label, b.label) * (1.0F + kSmallSlack / smaller);
    if (distanceOf(a.mean(), b.mean()) < limit) join(first, second);
  }
}

void SegmentMerger::addBorder(int first, int second, float contrast) {
  if (first > second) std::swap(first, second);
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = (indexOf(first) * 2654435761U + indexOf(second) * 40503U) & mask;
  while (slots_[slot] >= 0) {
    Border& known = borders_[indexOf(slots_[slot])];
    if (known.first == first && known.second == second) {
      known.contrast += contrast;
      known.squares += contrast * contrast;
      ++known.length;
      return;
    }
    slot = (slot + 1) & mask;
  }
  slots_[slot] = static_cast<int>(borders_.size());
  borders_.push_back({first, second, contrast, contrast * contrast, 1});
}

/// The contrast across the borders of regions, and of what is within them, between cells three
/// steps apart.
void SegmentMerger::findBorders() {
  borders_.clear();
  std::ranges::fill(slots_, -1);
  std::ranges::fill(textureSums_, 0.0);
  std::ranges::fill(textureCounts_, 0);
  const auto look = [this](int cell, int step, bool hasBefore, bool hasAfter) {
    const int first = segments_[indexOf(cell)];
    const int second = segments_[indexOf(cell + step)];
    const bool isFirst = hasBefore && segments_[indexOf(cell - step)] == first;
    const bool isSecond = hasAfter && segments_[indexOf(cell + 2 * step)] == second;
    if (first == second && (!isFirst || !isSecond)) return;
    const CellColour& one = colours_[indexOf(isFirst ? cell - step : cell)];
    const CellColour& other = colours_[indexOf(isSecond ? cell + 2 * step : cell + step)];
    const float contrast = distanceOf(one, other);
    if (first != second) return addBorder(first, second, contrast);
    textureSums_[indexOf(first)] += contrast;
    ++textureCounts_[indexOf(first)];
  };
  for (int i = 0; i < static_cast<int>(segments_.size()); ++i) segments_[indexOf(i)] = rootOf(i);
  for (int y = 0; y < grid_.height; ++y) {
    for (int x = 0; x < grid_.width; ++x) {
      const int cell = y * grid_.width + x;
      if (x + 1 < grid_.width) look(cell, 1, x > 0, x + 2 < grid_.width);
      if (y + 1 < grid_.height) look(cell, grid_.width, y > 0, y + 2 < grid_.height);
    }
  }
  for (std::size_t i = 0; i < regions_.size(); ++i) {
    regions_[i].texture =
        textureCounts_[i] > 0 ? static_cast<float>(textureSums_[i] / textureCounts_[i]) : 0.0F;
  }
}

/// Merges what no clear border separates; whether there was anything.
bool SegmentMerger::mergeByBorders() {
  std::ranges::sort(borders_, [](const Border& a, const Border& b) {
    const float one = a.clear();
    const float other = b.clear();
    if (one != other) return one < other;
    return a.first != b.first ? a.first < b.first : a.second < b.second;
  });
  bool hasMerged = false;
  for (const Border& border : borders_) {
    const int first = rootOf(border.first);
    const int second = rootOf(border.second);
    if (first == second) continue;
    const Region& a = regions_[indexOf(first)];
    const Region& b = regions_[indexOf(second)];
    const float texture = kTexture * 0.5F * (a.texture + b.texture);
    const float limit = std::max(kClearBorder, texture) * biasOf(a.label, b.label);
    if (border.clear() >= limit) continue;
    join(first, second);
    hasMerged = true;
  }
  return hasMerged;
}

/// Regions that are too small, or nowhere three cells wide, are no segments.
void SegmentMerger::leaveOutSpecks() {
  const int width = grid_.width;
  for (int i = 0; i < static_cast<int>(segments_.size()); ++i) segments_[indexOf(i)] = rootOf(i);
  cores_.assign(segments_.size(), 0);
  for (int y = 1; y + 1 < grid_.height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      const int cell = y * width + x;
      const int own = segments_[indexOf(cell)];
      bool isCore = true;
      for (int i = 0; i < 9 && isCore; ++i) {
        isCore = segments_[indexOf(cell + (i / 3 - 1) * width + i % 3 - 1)] == own;
      }
      cores_[indexOf(own)] += isCore ? 1 : 0;
    }
  }
  for (int& segment : segments_) {
    const Region& region = regions_[indexOf(segment)];
    const float slack = region.label != 0 ? 1.0F - kHold : 1.0F;
    const bool isLarge = static_cast<float>(region.cells) >= slack * kLeastCells &&
                         static_cast<float>(cores_[indexOf(segment)]) >= slack * kLeastCores;
    if (!isLarge) segment = kUnsure;
  }
}

/// The number of cells in each connected gap, at its cells.
void SegmentMerger::measureGaps() {
  gaps_.assign(segments_.size(), 0);
  for (int first = 0; first < static_cast<int>(segments_.size()); ++first) {
    if (segments_[indexOf(first)] != kUnsure || gaps_[indexOf(first)] != 0) continue;
    queue_.assign(1, first);
    gaps_[indexOf(first)] = 1;
    for (std::size_t i = 0; i < queue_.size(); ++i) {
      forNeighbours(queue_[i], [this](int at) {
        if (segments_[indexOf(at)] != kUnsure || gaps_[indexOf(at)] != 0) return;
        gaps_[indexOf(at)] = 1;
        queue_.push_back(at);
      });
    }
    for (const int cell : queue_) gaps_[indexOf(cell)] = static_cast<int>(queue_.size());
  }
}

/// Cells of gaps go to the segment beside them that is the most alike: all of small gaps, the rim
/// of larger ones.
void SegmentMerger::fillGaps() {
  measureGaps();
  bool isFirst = true;
  for (bool hasFilled = true; hasFilled; isFirst = false) {
    hasFilled = false;
    next_.assign(segments_.begin(), segments_.end());
    for (int cell = 0; cell < static_cast<int>(segments_.size()); ++cell) {
      if (segments_[indexOf(cell)] != kUnsure) continue;
      if (!isFirst && gaps_[indexOf(cell)] > kLargestSpeck) continue;
      float least = std::numeric_limits<float>::max();
      forNeighbours(cell, [&](int at) {
        const int segment = segments_[indexOf(at)];
        if (segment == kUnsure) return;
        const Region& region = regions_[indexOf(segment)];
        const float away = distanceOf(colours_[indexOf(cell)], region.mean()) /
                           biasOf(region.label, carried_[indexOf(cell)]);
        if (away >= least) return;
        least = away;
        next_[indexOf(cell)] = segment;
        hasFilled = true;
      });
    }
    segments_.swap(next_);
  }
}

/// Numbers the segments from 0 on, in the order of their first cells.
void SegmentMerger::number() {
  numbers_.assign(segments_.size(), kUnsure);
  count_ = 0;
  for (int& segment : segments_) {
    if (segment == kUnsure) continue;
    int& number = numbers_[indexOf(segment)];
    if (number == kUnsure) number = count_++;
    segment = number;
  }
}

void SegmentMerger::merge(hal::FrameSize grid, std::span<const CellColour> colours,
                          std::span<const std::uint16_t> carried) {
  const auto cells = static_cast<std::size_t>(grid.pixels());
  assert(colours.size() == cells && carried.size() == cells);
  grid_ = grid;
  colours_ = colours;
  carried_ = carried;
  parents_.resize(cells);
  std::iota(parents_.begin(), parents_.end(), 0);
  segments_.resize(cells);
  textureSums_.resize(cells);
  textureCounts_.resize(cells);
  regions_.resize(cells);
  std::size_t slots = 1;
  while (slots < 4 * cells) slots *= 2;  // two borders a cell at most
  slots_.resize(slots);
  for (auto* const each : {&edges_, &sorted_}) each->reserve(2 * cells);
  weights_.reserve(2 * cells);
  borders_.reserve(2 * cells);
  queue_.reserve(cells);
  for (std::size_t i = 0; i < cells; ++i) {
    regions_[i] = {colours[i].luma, colours[i].cb, colours[i].cr, 1, carried[i], 0.0F};
  }
  sortEdges();
  mergeByMeans();
  for (int round = 0; round < kRounds; ++round) {
    findBorders();
    if (!mergeByBorders()) break;
  }
  leaveOutSpecks();
  fillGaps();
  number();
}

}  // namespace pleinair::tracking
