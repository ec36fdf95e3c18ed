#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <glm/vec4.hpp>

#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// The segments of the camera image (ArFrame::measuredSegments) as shaders/segments.glsl reads
/// them. All calls on the thread of the GL context that was current at the first update().
class SegmentMap {
 public:
  /// Takes the frame's segments; a frame without any has none. Throws hal::Failure if GPU memory
  /// for a grid of another size runs out.
  void update(const scene::ArFrame& frame);
  bool hasSegments() const { return hasSegments_; }
  /// Binds the inputs of shaders/segments.glsl; `noCells` is bound where there are no segments.
  /// Precondition: the program is in use.
  static void bind(gpu::Program& program, const SegmentMap* map, const gpu::Texture& noCells);

 private:
  gpu::Texture cells_;  // R32UI
  std::vector<std::uint32_t> packed_;
  bool hasSegments_ = false;
  glm::vec4 grid_{0.0F};  // cell = px of the full image * xy + zw
};

}  // namespace pleinair::marks
