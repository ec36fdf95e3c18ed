#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/cameras/synthetic/render/projection.h"

namespace pleinair::hal::synthetic {

/// Visibility along one row of pixels: the facet that each pixel shows or, at edges, the coverage
/// of each facet. Traces four lines across the row's height and finds the exact places where one
/// facet occludes the next, so that edges are antialiased. Reuses its memory.
class ScanLine {
 public:
  static constexpr std::uint16_t kMixed = 0xFFFF;
  static constexpr std::uint16_t kNothing = 0xFFFE;  ///< also the end of the valid facet indices

  /// A facet's coverage of a mixed pixel.
  struct Share {
    std::uint16_t index = kNothing;  ///< index into the facets given to trace()
    float coverage = 0;
  };

  void resize(int width);

  /// Traces row `y`. `facets` holds the facets that may reach the row, in any order; it is
  /// reordered to make the next row fast. Indices refer to `all`.
  void trace(int y, std::span<const ProjectedFacet> all, std::vector<std::uint16_t>& facets);

  /// The facet at pixel x, kNothing or kMixed.
  std::uint16_t indexAt(int x) const { return indices_[static_cast<std::size_t>(x)]; }
  /// The coverage of a mixed pixel's facets, with sum 1; valid until the next call.
  std::span<const Share> sharesAt(int x);

 private:
  static constexpr int kLines = 4;
  struct Segment {
    float left = 0, right = 0;
    double slope = 0, one = 0;  ///< 1/depth along the line
    std::uint16_t index = 0;
  };
  struct Part {
    Share share;
    std::int32_t next = -1;
  };

  void intersect(float y, std::span<const ProjectedFacet> all,
                 const std::vector<std::uint16_t>& facets);
  void resolve(int line);
  void put(int line, float from, float to, std::uint16_t index);
  void putPart(int line, int x, std::uint16_t index, float coverage);
  void merge();

  int width_ = 0;
  std::vector<Segment> segments_;
  std::vector<const Segment*> open_;
  std::array<std::vector<std::uint16_t>, kLines> lines_;
  std::vector<std::uint16_t> indices_;
  std::vector<Part> parts_;
  std::vector<std::int32_t> firstPart_;
  std::vector<Share> shares_;
};

}  // namespace pleinair::hal::synthetic
