#include "pipeline/marks/movers/background_binding.h"

#include "pipeline/marks/movers/motion_layers.h"

namespace pleinair::marks {

BackgroundBinding::BackgroundBinding(hal::FrameSize full)
    : full_(full),
      noIds_(gpu::TextureFormat::kR32ui, {1, 1}),
      noMotion_(gpu::TextureFormat::kRgba16f, {1, 1}) {}

void BackgroundBinding::bind(gpu::Program& program, const scene::ArFrame& frame,
                             const MotionField& field, std::uint64_t last) const {
  const bool hasSurfaces = knowsSurfaces(frame, field, last);
  program.texture("ids", frame.hasObjects ? *frame.ids : noIds_)
      .texture("surfaceMotion", hasSurfaces ? *frame.motion->texture : noMotion_)
      .set("hasObjects", frame.hasObjects ? 1 : 0)
      .set("hasSurfaces", hasSurfaces ? 1 : 0)
      .set("pixelsOfFull", glm::vec2(frame.pixelsOfFull()))
      .set("fullSize", glm::vec2(full_.width, full_.height))
      .set("isStanding", field.isStanding() ? 1 : 0);
}

bool knowsSurfaces(const scene::ArFrame& frame, const MotionField& field, std::uint64_t last) {
  return frame.motion && field.follows() && frame.motion->sinceSequence == last;
}

float cellNoise(const MotionField& field) {
  return static_cast<float>(field.noiseLevels() / 255.0 / MotionLayers::kCellPixels);
}

}  // namespace pleinair::marks
