#pragma once

#include <cstdint>
#include <memory>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "hal/clock.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/anchor_set.h"
#include "pipeline/marks/tensor_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// How the strokes of a layer are grown and how they hold on to their past. Px are of the full
/// picture; colours sRGB-coded in [0, 1], their differences weighted lengths (stroke_trace.comp).
struct StrokeRule {
  float segmentPx = 8.0F;
  float steps = 4.0F;                ///< of each arm, at most 4
  float leastSteps = 0.5F;           ///< neither colour nor detail stops it earlier
  float colourThreshold = 0.12F;     ///< the difference from the anchor's colour at which it ends
  float cutOffRad = 0.8F;            ///< the turn between two segments at which it ends
  glm::vec2 detailBand{0.0F, 1e9F};  ///< where the layer is painted (TensorField::resolved)
  float modelDetail = 1.0F;          ///< how many times as much detail counts on virtual surfaces
  float detailSpread = 0.0F;         ///< by how much anchors differ about the band
  float slack = 0.25F;               ///< the part by which it is wider for strokes that are there
  float wanderRad = 0.1F;            ///< how far a stroke strays from the field, at most
  bool bothWays = true;              ///< else only ahead of the anchor, as the thesis walks
  std::size_t fieldLevel = 0;        ///< of the tensor field; beyond its last: the last
  float widthPx = 8.0F;
  float widthSpread = 0.2F;                ///< ± this part of the width
  float opacity = 1.0F;                    ///< in [0, 1]
  const gpu::Texture* mixtures = nullptr;  ///< a limited palette (shaders/mixture.glsl); none: all
  float leaveLight = 0.0F;  ///< in [0, 1]: by how much the lightest strokes are thinner paint
  glm::vec3 jitter{0.02F, 0.1F, 0.05F};                        ///< of hue, saturation, value; parts
  int quads = 8;                                               ///< at most, of a stroke
  hal::Duration shapeMemory = std::chrono::milliseconds(650);  ///< time constants; 0: none
  hal::Duration colourMemory = std::chrono::milliseconds(650);
  hal::Duration appearing = std::chrono::milliseconds(300);
  hal::Duration vanishing = std::chrono::milliseconds(300);
  float mostColourPerSecond = 1.5F;  ///< by which a stroke's colour changes, at most
};

/// The pictures that colours are of, of any size (LINEAR, sRGB-coded, premultiplied): what is real,
/// and what models show; where there are none, the same.
struct StrokePaint {
  const gpu::Texture* real = nullptr;
  const gpu::Texture* models = nullptr;
};

/// The strokes of an AnchorSet's anchors: grown along a tensor field (thesis §4.4), blended with
/// what they were (§4.5, §5.4), and laid out to be drawn in an order that never changes while they
/// live. All on the GPU. All calls on the thread of the GL context it was made in.
class StrokeSet {
 public:
  /// `library` has gpu::marksShaders(), gpu::sceneShaders() and gpu::gpuShaders(); `slotCount` is
  /// the AnchorSet's. Throws hal::Failure where the GPU has no memory for them.
  StrokeSet(const gpu::ShaderLibrary& library, std::uint32_t slotCount);
  ~StrokeSet();
  StrokeSet(const StrokeSet&) = delete;
  StrokeSet& operator=(const StrokeSet&) = delete;
  StrokeSet(StrokeSet&&) = delete;
  StrokeSet& operator=(StrokeSet&&) = delete;

  /// Grows the strokes of the frame that `anchors` and `field` were brought to. Where the anchors
  /// have begun anew, strokes are what the frame says, without a past. Preconditions: both are of
  /// frame.full(), and the anchors have the constructor's number of slots.
  void update(const scene::ArFrame& frame, const AnchorSet& anchors, const TensorField& field,
              const StrokePaint& paint, const StrokeRule& rule);

  /// Of each stroke that is seen, in the order of painting: four pairs of points, paint, shape
  /// (shaders/stroke_instances.comp), 96 bytes; and glDrawArraysIndirect's command for triangle
  /// strips of verticesOf(rule.quads) each.
  const gpu::Buffer& instances() const;
  const gpu::Buffer& command() const;
  static constexpr std::size_t kInstanceBytes = 96;
  static int verticesOf(int quads) { return 2 * (quads + 1); }
  /// What is kept of each slot's stroke, as shaders/stroke.glsl has it.
  const gpu::Buffer& strokes() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
