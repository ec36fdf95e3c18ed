#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"

namespace pleinair::marks {

/// A point, as stored in its slot (shaders/point_bins.glsl).
struct BinnedPoint {
  glm::ivec2 at{0};          ///< px of the image in 1/64, so that distances are exact integers
  std::int32_t penalty = 0;  ///< added to squared distances, px² in 1/4096
  std::int32_t slot = kNone;

  static constexpr std::int32_t kNone = -1;  ///< the slot of an entry without a point
  static constexpr float kUnits = 64.0F;     ///< per px
};
static_assert(sizeof(BinnedPoint) == 16);

/// Moving points, sorted into rectangular bins of the image, so that a pixel finds its nearest
/// points without testing all (shaders/point_bins.glsl). All data stays on the GPU. The order
/// depends on the points alone: bins row by row, slots in rising order within a bin. Points outside
/// the image belong to the nearest bin. All calls on the thread of the GL context that was current
/// at construction.
class PointBins {
 public:
  /// `library` has gpu::marksShaders().
  explicit PointBins(const gpu::ShaderLibrary& library);

  /// Allocates `slots` points in `bins` bins, and discards the sorted points. Throws hal::Failure
  /// if GPU memory runs out.
  void allocate(hal::FrameSize bins, std::uint32_t slots);

  /// Sorts a buffer of BinnedPoints, one per slot, in px of an image of this size.
  void sort(const gpu::Buffer& points, hal::FrameSize picture);

  /// bins + 1 unsigned integers: the start of each bin in sorted().
  const gpu::Buffer& starts() const { return starts_; }
  /// The valid BinnedPoints, sorted by bin.
  const gpu::Buffer& sorted() const { return sorted_; }
  glm::ivec2 bins() const { return bins_; }
  /// Side lengths of a bin in an image of this size, px.
  glm::vec2 binPixels(hal::FrameSize picture) const;

 private:
  gpu::Program link_;
  gpu::Program scan_;
  gpu::Program gather_;
  glm::ivec2 bins_{0};
  std::uint32_t slots_ = 0;
  gpu::Buffer links_;  // a count and a first slot per bin, then the next slot for each slot
  gpu::Buffer starts_;
  gpu::Buffer sorted_;
};

}  // namespace pleinair::marks
