#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/program.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/anchors/anchor_set.h"
#include "pipeline/marks/anchors/point_bins.h"
#include "pipeline/marks/fidelity_field.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/layer_textures.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/styles/strokes/stroke_strips.h"

namespace pleinair::styles {

/// What a set of lines is made for; a change makes new ones. Px are those of the full image.
struct HatchPlan {
  double spacingPx = 5.0;  ///< between neighbouring lines
  double lengthPx = 64.0;  ///< of the longest
  double coverage = 2.0;   ///< lines that lie over each other
  unsigned seed = 1;

  bool operator==(const HatchPlan&) const = default;
};

/// How the lines of a set are drawn in a frame. Px are those of the full image.
struct HatchRule {
  glm::vec2 band{0.0F, 1.0F};  ///< of tone: from no line to all of them (shaders/tone.glsl)
  float swell = 0.5F;
  float widthPx = 1.5F;
  bool isInverted = false;
  float darkness = 1.0F;
  float gamma = 1.0F;
  float lead = 1.0F;      ///< the field's weight beside the slope's
  glm::vec2 slope{1, 0};  ///< a tensor (shaders/field.glsl)
  float turnRad = 0.0F;   ///< of the set, against the field
  float wanderRad = 0.0F;
  float cutOffRad = 0.6F;
  float taper = 0.2F;
  float evenness = 0.0F;  ///< of the spacing; 0: by chance
  std::size_t fieldLevel = 0;
  hal::Duration shapeMemory = std::chrono::milliseconds(650);  ///< time constant; 0: none
  hal::Duration fade =
      std::chrono::milliseconds(700);  ///< in which a line comes or goes; 0: at once
  glm::vec4 paint{0.0F, 0.0F, 0.0F, 1.0F};
  float colour = 0.0F;  ///< in [0, 1]: how much of the image's colour the paint takes
  float rankColour = 0.0F;
  marks::FidelityField fidelity;  ///< where lines leave more to contours
};

/// The lines of one direction of hatching, each at an anchor of its own: traced along the tensor
/// field, held over time, as wide at each place as its tone asks for. Ranks are nested: a darker
/// tone has all lines of a lighter one, and none of them thinner. All data stays on the GPU. All
/// calls on the thread of the GL context that was current at construction.
class HatchLines {
 public:
  /// `library` has gpu::hatchingShaders(), strokesShaders(), marksShaders(), sceneShaders() and
  /// gpuShaders(). `full` is the size of the full image. Throws hal::Failure if GPU memory runs
  /// out.
  HatchLines(const gpu::ShaderLibrary& library, hal::FrameSize full, const HatchPlan& plan);

  struct Inputs {
    const marks::MotionField* motion = nullptr;
    const marks::TensorField* field = nullptr;
    const gpu::Texture* tone = nullptr;  ///< shaders/tone.frag's
    /// null: nothing moves by itself. The colours behind movers come from them, too.
    const marks::MotionLayers* movers = nullptr;
    const gpu::Texture* colours = nullptr;  ///< the image whose colours lines may take (LINEAR)
  };
  /// Traces the lines of a frame, for which the inputs were updated. The lines of a first frame,
  /// after reset() and after a cut have no past.
  void update(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule);
  /// The lines, laid out for drawing.
  const StrokeStrips& strips() const { return strips_; }

  const marks::AnchorSet& anchors() const { return anchors_; }
  /// A line in each slot (shaders/line.glsl).
  const gpu::Buffer& lines() const { return lines_; }
  static constexpr std::size_t kLineBytes = 96;
  /// The drawn lines (strokes/shaders/long_instance.glsl), and how many.
  const gpu::Buffer& instances() const { return instances_; }
  const gpu::Buffer& command() const { return command_; }
  /// The length of a traced segment, px.
  float segmentPx() const { return segmentPx_; }

  void reset() { anchors_.reset(); }

 private:
  void bindField(gpu::Program& program, const scene::ArFrame& frame, const Inputs& inputs,
                 const HatchRule& rule, std::size_t level) const;
  void bindSupport(gpu::Program& program, const scene::ArFrame& frame,
                   const marks::MotionLayers* movers) const;
  void align(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule,
             hal::Duration step);
  void trace(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule,
             hal::Duration step);
  void layOut(const scene::ArFrame& frame, const Inputs& inputs, const HatchRule& rule);

  HatchPlan plan_;
  marks::AnchorSet anchors_;
  std::uint32_t slots_;
  float segmentPx_;
  gpu::Program points_;
  gpu::Program align_;
  gpu::Program trace_;
  gpu::Program order_;
  gpu::Program lay_;
  StrokeStripMaker stripMaker_;
  marks::PointBins bins_;
  gpu::Buffer binned_;
  std::array<gpu::Texture, 2> shifts_;  // of this step and the previous one
  std::size_t latest_ = 0;
  gpu::Buffer lines_;
  gpu::Buffer ranks_;
  gpu::Buffer command_;
  gpu::Buffer instances_;
  StrokeStrips strips_;
  gpu::Texture noIds_;
  marks::LayerTextures layerTextures_;
  hal::TimePoint lastTime_;
};

/// Binds what shaders/tone.glsl reads.
void bindHatchTone(gpu::Program& program, const scene::ArFrame& frame, const gpu::Texture& tone,
                   const HatchRule& rule);

}  // namespace pleinair::styles
