#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include <glm/vec2.hpp>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/marks/anchors/anchor.h"
#include "pipeline/marks/fidelity_field.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/motion_layers.h"
#include "pipeline/marks/tensors/tensor_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// Density control (thesis §5.3, with hysteresis): a cell with fewer anchors than `birthBelow` is
/// filled up to `target`; a cell with more than `deathAbove` loses one per frame. In between,
/// nothing changes, which keeps the turnover low. In a cell that shows both models and the camera
/// image, each of the two gets its share.
struct DensityRule {
  int cellPixels = 8;  ///< side of a cell, in px of the full image
  int target = 2;
  int birthBelow = 1;
  int deathAbove = 4;
  /// Marks are cut short where there is much detail: in the camera's image and on movers, the three
  /// numbers above are multiplied there, by 1 up to the first of `detailRange`
  /// (TensorField::resolved), by this from the second on; only if advance() is given the field. At
  /// most 15.
  float detailFactor = 1.0F;
  glm::vec2 detailRange{0.0F, 1.0F};
  /// Marks are smaller where fidelity is higher (AnchorHold::fidelity): there, the numbers are
  /// multiplied by up to this, by less where it would be for more than 2.5 % of the image. At most
  /// 15.
  float faithfulFactor = 1.0F;
};

struct AnchorOptions {
  DensityRule density;
  unsigned seed = 1;  ///< seeds all random numbers
  /// px of the full image: births in the camera's image prefer places where something narrower is
  /// seen, which chance would often miss; 0: they do not
  float accentPixels = 0.0F;
};

/// How anchors persist from frame to frame; may change with each frame.
struct AnchorHold {
  /// time from invisible to visible; 0: at once
  hal::Duration fadeIn = std::chrono::milliseconds(300);
  /// time from visible to invisible; 0: at once
  hal::Duration fadeOut = std::chrono::milliseconds(200);
  /// the longest that it is on movers, whose anchors are soon too many on one side
  hal::Duration moverFadeOut = std::chrono::milliseconds(200);
  /// how long an anchor is kept that other content covers, so that its mark is the same one when it
  /// is seen again; at most 255 s. Where slots run short, it is given up earlier.
  hal::Duration memory = std::chrono::seconds(30);
  /// Whether anchors of the camera image that a virtual model covers are kept in the same way, for
  /// styles that clip their marks there. If false, they fade out.
  bool underModels = false;
  bool hasSlack = true;  ///< hysteresis of DensityRule; if false, density is kept at the target
  /// the same on movers; if false, density is kept at their share of the target, but for two
  /// anchors
  bool hasMoverSlack = true;
  FidelityField fidelity;  ///< where DensityRule::faithfulFactor applies
};

/// The anchors of a style's marks. They are spawned where the image has too few, follow the surface
/// that they lie on (exactly on a model; else by the best known image motion), and fade out when a
/// model occludes their surface or their cell is too crowded. An anchor that a mover covers stays,
/// for AnchorHold::memory: its mark is to remain as it is, with the mover drawn over it. An anchor
/// keeps its slot for life, so that styles can store the data of its mark in parallel buffers. All
/// data stays on the GPU; nothing is read back. The same frames with the same times give the same
/// anchors. All calls on the thread of the GL context that was current at construction.
class AnchorSet {
 public:
  /// `library` has gpu::marksShaders(), gpu::sceneShaders() and gpu::gpuShaders(). `full` is the
  /// size of the full image. Throws hal::Failure if GPU memory runs out.
  AnchorSet(const gpu::ShaderLibrary& library, hal::FrameSize full, AnchorOptions options);
  ~AnchorSet();
  AnchorSet(const AnchorSet&) = delete;
  AnchorSet& operator=(const AnchorSet&) = delete;
  AnchorSet(AnchorSet&&) = delete;
  AnchorSet& operator=(AnchorSet&&) = delete;

  /// Advances to the next frame, for which `motion` and `layers` have been updated; without layers,
  /// no anchor is covered. `field`, which has been updated as well, knows what models showed
  /// before: with it, the marks of surfaces that come to sight do not fade in. The first frame, a
  /// frame after reset() and a frame after a cut start anew, with all anchors visible at once.
  /// Preconditions: frame.full() is the constructor's size; the style's needs include surfaces and
  /// measuredMotion.
  void advance(const scene::ArFrame& frame, const MotionField& motion, const AnchorHold& hold = {},
               const MotionLayers* layers = nullptr, const TensorField* field = nullptr);
  /// Whether the last advance() started anew, so that data which a style stores per slot is
  /// invalid.
  bool hasBegunAnew() const;

  /// slotCount() Anchors; a slot without kAlive is free.
  const gpu::Buffer& anchors() const;
  std::uint32_t slotCount() const;
  const AnchorOptions& options() const;
  /// The scale of the image as compared to when the anchors began, in octaves of length: that of
  /// Anchor::rank() elsewhere than on virtual surfaces.
  double imageScale() const;

  /// Waits for the GPU and reads all slots: for measures and tests. All slots are free if the GPU
  /// was lost.
  std::vector<Anchor> read() const;

  /// Makes the next advance() start anew, with other anchors than before.
  void beginAnew();
  /// Forgets the past: the next advance() starts anew, with the anchors of a first frame.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
