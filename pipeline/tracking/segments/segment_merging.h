#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/pixel_format.h"
#include "pipeline/tracking/segments/cell_colours.h"

namespace pleinair::tracking {

/// Divides a grid of colours into segments, in three steps. Cells are merged in the order of their
/// differences while the mean colours of their segments are alike (Nock and Nielsen, "Statistical
/// region merging", 2004). Segments are merged whose common border has little contrast, measured
/// beyond the cells that the border crosses, or no more than they have within: so soft shading and
/// texture make no borders. Strips of mixed colour along a border, and specks, go to the segments
/// beside them; larger patches of small-scaled content have no segment.
///
/// Hysteresis: what had the same label in the previous frame is merged more readily, what had
/// different ones less, so that noise changes nothing. The result depends on nothing else; it is
/// the same on every run. Keeps its buffers; one thread at a time.
class SegmentMerger {
 public:
  static constexpr int kUnsure = -1;

  /// `carried`: the label that each cell's content had in the previous frame; 0: unknown or none.
  void merge(hal::FrameSize grid, std::span<const CellColour> colours,
             std::span<const std::uint16_t> carried);
  /// The segment of each cell, from 0, or kUnsure; valid until the next call.
  std::span<const int> segments() const { return segments_; }
  int count() const { return count_; }

 private:
  struct Region {
    double luma = 0.0;
    double cb = 0.0;
    double cr = 0.0;
    int cells = 0;
    std::uint16_t label = 0;  // carried, of its largest part
    float texture = 0.0F;     // mean contrast within
    CellColour mean() const {
      const double part = 1.0 / cells;
      return {static_cast<float>(part * luma), static_cast<float>(part * cb),
              static_cast<float>(part * cr)};
    }
  };
  struct Edge {
    int first;
    int second;
  };
  struct Border {
    int first;
    int second;
    double contrast;  // sums
    double squares;
    int length;
    /// What most of the border has: its mean contrast less a part of its deviation.
    float clear() const {
      const double mean = contrast / length;
      const double variance = std::max(0.0, squares / length - mean * mean);
      return static_cast<float>(mean - kDeviations * std::sqrt(variance));
    }
    static constexpr double kDeviations = 0.6;
  };

  template <class Body>
  void forNeighbours(int cell, const Body& body) const;
  int rootOf(int cell);
  void join(int first, int second);
  void sortEdges();
  void mergeByMeans();
  void findBorders();
  void addBorder(int first, int second, float contrast);
  bool mergeByBorders();
  void leaveOutSpecks();
  void measureGaps();
  void fillGaps();
  void number();

  hal::FrameSize grid_;
  std::span<const CellColour> colours_;
  std::span<const std::uint16_t> carried_;
  std::vector<int> parents_;
  std::vector<Region> regions_;  // of each root
  std::vector<int> bins_;
  std::vector<std::uint16_t> weights_;
  std::vector<Edge> edges_;
  std::vector<Edge> sorted_;
  std::vector<Border> borders_;
  std::vector<int> slots_;  // hash table of borders_
  std::vector<double> textureSums_;
  std::vector<int> textureCounts_;
  std::vector<int> cores_;
  std::vector<int> segments_;
  std::vector<int> next_;
  std::vector<int> gaps_;
  std::vector<int> queue_;
  std::vector<int> numbers_;
  int count_ = 0;
};

}  // namespace pleinair::tracking
