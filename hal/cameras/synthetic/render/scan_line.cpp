#include "hal/cameras/synthetic/render/scan_line.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace pleinair::hal::synthetic {

void ScanLine::resize(int width) {
  width_ = width;
  const auto count = static_cast<std::size_t>(width);
  for (std::vector<std::uint16_t>& line : lines_) line.resize(count);
  indices_.resize(count);
  firstPart_.resize(count);
}

void ScanLine::trace(int y, std::span<const ProjectedFacet> all,
                     std::vector<std::uint16_t>& facets) {
  parts_.clear();
  std::ranges::fill(firstPart_, -1);
  for (int line = 0; line < kLines; ++line) {
    intersect(static_cast<float>(y) + (static_cast<float>(line) + 0.5F) / kLines, all, facets);
    // Insertion sort: the order is nearly right already, since consecutive lines cross facets in
    // much the same order.
    for (std::size_t i = 1; i < segments_.size(); ++i) {
      const Segment moved = segments_[i];
      std::size_t at = i;
      for (; at > 0 && segments_[at - 1].left > moved.left; --at) segments_[at] = segments_[at - 1];
      segments_[at] = moved;
    }
    resolve(line);
  }
  merge();
  // Moves the facets that were crossed to the front, in their order; the others keep theirs.
  std::size_t placed = 0;
  for (const Segment& segment : segments_) {
    const auto at = std::find(facets.begin() + static_cast<std::ptrdiff_t>(placed), facets.end(),
                              segment.index);
    if (at == facets.end()) continue;
    std::rotate(facets.begin() + static_cast<std::ptrdiff_t>(placed), at, at + 1);
    ++placed;
  }
}

void ScanLine::intersect(float y, std::span<const ProjectedFacet> all,
                         const std::vector<std::uint16_t>& facets) {
  segments_.clear();
  const auto end = static_cast<float>(width_);
  for (const std::uint16_t index : facets) {
    const ProjectedFacet& facet = all[index];
    if (y < facet.top || y >= facet.bottom) continue;
    float left = std::numeric_limits<float>::infinity();
    float right = -left;
    for (const ProjectedFacet::Edge& edge : facet.edges) {
      if (y < edge.y || y >= edge.endY) continue;
      const float x = edge.x + (y - edge.y) * edge.slope;
      left = std::min(left, x);
      right = std::max(right, x);
    }
    left = std::max(left, 0.0F);
    right = std::min(right, end);
    if (left >= right) continue;
    const ImageLinear& depth = facet.inverseDepth;
    segments_.push_back(
        {left, right, depth.x, depth.y * static_cast<double>(y) + depth.one, index});
  }
}

void ScanLine::resolve(int line) {
  const auto end = static_cast<float>(width_);
  open_.clear();
  auto next = segments_.begin();
  float at = 0;
  float begun = 0;
  std::uint16_t shown = kNothing;
  while (at < end) {
    std::erase_if(open_, [at](const Segment* each) { return each->right <= at; });
    for (; next != segments_.end() && next->left <= at; ++next) {
      if (next->right > at) open_.push_back(&*next);
    }
    float until = next == segments_.end() ? end : std::min(end, next->left);
    for (const Segment* each : open_) until = std::min(until, each->right);
    const double middle = (static_cast<double>(at) + static_cast<double>(until)) / 2;
    double nearest = 0;
    std::uint16_t front = kNothing;
    for (const Segment* each : open_) {
      const double inverseDepth = each->slope * middle + each->one;
      if (inverseDepth > nearest) {
        nearest = inverseDepth;
        front = each->index;
      }
    }
    if (front != shown) {
      put(line, begun, at, shown);
      begun = at;
      shown = front;
    }
    at = until;
  }
  put(line, begun, end, shown);
}

void ScanLine::put(int line, float from, float to, std::uint16_t index) {
  if (from >= to) return;
  std::vector<std::uint16_t>& out = lines_[static_cast<std::size_t>(line)];
  auto first = static_cast<int>(from);
  const auto last = static_cast<int>(to);
  const float into = from - static_cast<float>(first);
  const float over = to - static_cast<float>(last);
  if (first == last) return putPart(line, first, index, to - from);
  if (into > 0) putPart(line, first++, index, 1 - into);
  if (over > 0) putPart(line, last, index, over);
  std::fill(out.begin() + first, out.begin() + last, index);
}

void ScanLine::putPart(int line, int x, std::uint16_t index, float coverage) {
  lines_[static_cast<std::size_t>(line)][static_cast<std::size_t>(x)] = kMixed;
  std::int32_t& first = firstPart_[static_cast<std::size_t>(x)];
  parts_.push_back({{index, coverage / kLines}, first});
  first = static_cast<std::int32_t>(parts_.size()) - 1;
}

void ScanLine::merge() {
  for (int x = 0; x < width_; ++x) {
    const auto i = static_cast<std::size_t>(x);
    const std::uint16_t index = lines_[0][i];
    const bool agree = index == lines_[1][i] && index == lines_[2][i] && index == lines_[3][i];
    indices_[i] = agree ? index : kMixed;
  }
}

std::span<const ScanLine::Share> ScanLine::sharesAt(int x) {
  const auto i = static_cast<std::size_t>(x);
  shares_.clear();
  const auto add = [this](const Share& share) {
    const auto known = std::ranges::find(shares_, share.index, &Share::index);
    if (known == shares_.end()) {
      shares_.push_back(share);
    } else {
      known->coverage += share.coverage;
    }
  };
  for (const std::vector<std::uint16_t>& line : lines_) {
    if (line[i] != kMixed) add({line[i], 1.0F / kLines});
  }
  for (std::int32_t part = firstPart_[i]; part >= 0;
       part = parts_[static_cast<std::size_t>(part)].next) {
    add(parts_[static_cast<std::size_t>(part)].share);
  }
  return shares_;
}

}  // namespace pleinair::hal::synthetic
