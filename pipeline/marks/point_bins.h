#pragma once

#include <cstdint>

#include <glm/vec2.hpp>

#include "hal/pixel_format.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/program.h"
#include "pipeline/gpu/shader_library.h"

namespace pleinair::marks {

/// A point of a slot, as it lies in buffers (shaders/point_bins.glsl).
struct BinnedPoint {
  glm::ivec2 at{0};          ///< px of the picture in 1/64, so that distances are exact integers
  std::int32_t penalty = 0;  ///< what squared distances to it are lengthened by, px² in 1/4096
  std::int32_t slot = kNone;

  static constexpr std::int32_t kNone = -1;  ///< of a slot without a point
  static constexpr float kUnits = 64.0F;     ///< in a px
};
static_assert(sizeof(BinnedPoint) == 16);

/// Points that roam, sorted by the rectangle of the picture they lie in, so that a pixel's nearest
/// are found without asking all (shaders/point_bins.glsl). All on the GPU; the order depends on
/// nothing but the points: bins row by row, slots upwards in each. Points outside the picture
/// belong to the nearest bin. All calls on the thread of the GL context it was made in.
class PointBins {
 public:
  /// `library` has gpu::marksShaders().
  explicit PointBins(const gpu::ShaderLibrary& library);

  /// Makes room for `slots` points in `bins` bins; what was sorted is forgotten. Throws
  /// hal::Failure where the GPU has no memory for them.
  void allocate(hal::FrameSize bins, std::uint32_t slots);

  /// Sorts a buffer of BinnedPoints, one a slot, in px of a picture of this size.
  void sort(const gpu::Buffer& points, hal::FrameSize picture);

  /// bins + 1 unsigned integers: where each bin begins in sorted().
  const gpu::Buffer& starts() const { return starts_; }
  /// The BinnedPoints there are.
  const gpu::Buffer& sorted() const { return sorted_; }
  glm::ivec2 bins() const { return bins_; }
  /// Sides of a bin of a picture of this size, in its px.
  glm::vec2 binPixels(hal::FrameSize picture) const;

 private:
  gpu::Program link_;
  gpu::Program scan_;
  gpu::Program gather_;
  glm::ivec2 bins_{0};
  std::uint32_t slots_ = 0;
  gpu::Buffer links_;  // a count and a first slot for each bin, then the slot after each slot
  gpu::Buffer starts_;
  gpu::Buffer sorted_;
};

}  // namespace pleinair::marks
