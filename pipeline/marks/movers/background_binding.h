#pragma once

#include <cstdint>

#include "hal/pixel_format.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// The inputs of programs that include shaders/motion_layers.glsl: where the background was, also
/// where surfaces of models and planes are before it. All calls on the thread of the GL context that was current at
/// construction.
class BackgroundBinding {
 public:
  /// `full` is the size of the full image. Throws hal::Failure if GPU memory runs out.
  explicit BackgroundBinding(hal::FrameSize full);

  /// `last` is the sequence number of the previous frame. Precondition: the program is in use.
  void bind(gpu::Program& program, const scene::ArFrame& frame, const MotionField& field,
            std::uint64_t last) const;

 private:
  hal::FrameSize full_;
  gpu::Texture noIds_;
  gpu::Texture noMotion_;
};

/// Whether the motion of surfaces since the frame `last` is known.
bool knowsSurfaces(const scene::ArFrame& frame, const MotionField& field, std::uint64_t last);

/// Sigma of the sensor's noise in a cell of MotionLayers, which averages four px; in [0, 1].
float cellNoise(const MotionField& field);

}  // namespace pleinair::marks
