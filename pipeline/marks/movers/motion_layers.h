#pragma once

#include <chrono>
#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/gpu/programs/shader_library.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/marks/movers/busy_blocks.h"
#include "pipeline/scene/render/ar_frame.h"
#include "pipeline/scene/render/model_hiding.h"

namespace pleinair::marks {

struct MotionLayersOptions {
  /// after which a mover that has stopped counts as background, and so does what it covered last;
  /// at most 16 s, since it is counted in half floats: frames of high rates would add nothing
  hal::Duration rest = std::chrono::seconds(15);
  /// the same for one that is before a virtual model (FrontMovers)
  hal::Duration restBeforeModels = std::chrono::seconds(30);
};

/// Splits the camera image into the background, which goes with the camera, and movers, which move
/// by themselves. The background's colours are remembered and carried along the homography of
/// MotionField. A mover is what differs from them by more than noise, and has moved: it differs
/// from the previous frame too, or its measured motion is not the background's, or it was a mover
/// at its last place. Changes of light that leave edges where they are make no mover, nor does a
/// change of more than half of the image, or of less if most edges in it stay. What a mover
/// uncovers for the first time is background as soon as it rests, if the camera stands and it is
/// like its surroundings, else like any other mover. Where the background itself always differs
/// from its mean, as leaves in the wind do, a mover must differ by twice that more. What has
/// changed once and then rests, without a mover beside it, is background after 0.7 s. (Background
/// subtraction with a running mean: Piccardi, "Background subtraction techniques: a review", 2004.)
///
/// A mover's plain parts, and those along an edge, go with the others; so do parts all around which
/// it is, and which are not what is remembered there, and cracks along which it looks as what is
/// behind it does, but over which its colours go on; and, of people who move where they stood when
/// the camera began to look, faces and clothes that are remembered there (InPlaceMovers). What
/// comes in from outside before a camera that stands is a mover at once. Virtual models are looked
/// through: what moves behind them is known, too. Under parallax, near things may count as movers.
///
/// Movers are told from one another by a number each, of kMostMovers. Parts that hang together when
/// they are first seen are one mover. Its number goes with its motion, so that two that come
/// together remain two; where both might be, it is the one whose colours were there. More movers
/// than that share numbers, those far from one another. All calls on the thread of the GL context
/// that was current at construction.
class MotionLayers {
 public:
  /// `library` has gpu::marksShaders(), gpu::sceneShaders() and gpu::gpuShaders(). `full` is the
  /// size of the full image. Throws hal::Failure if GPU memory runs out.
  MotionLayers(const gpu::ShaderLibrary& library, hal::FrameSize full);
  ~MotionLayers();
  MotionLayers(const MotionLayers&) = delete;
  MotionLayers& operator=(const MotionLayers&) = delete;
  MotionLayers(MotionLayers&&) = delete;
  MotionLayers& operator=(MotionLayers&&) = delete;

  /// Adds a frame, for which `motion` has been updated. A cut forgets the background, and so does a
  /// change of frame.size(). Precondition: frame.full() is the constructor's size.
  void update(const scene::ArFrame& frame, const MotionField& motion,
              const MotionLayersOptions& options = {});

  /// RGBA16F, LINEAR; a texel is kCellPixels² px of the full image. R: 1 on movers, 0 on the
  /// background and on virtual models that are before them. G: 1 where this has just changed,
  /// falling to 0 within 0.3 s. B: how long a mover has rested, A: how long it has been seen to
  /// move, s; below 0 where it has left.
  const gpu::Texture& labels() const;
  BusyBlocks busyBlocks() const;
  /// RGBA8, LINEAR, as large: R, G, B: 1 where the movers 1, 2, 3 are. Their sum is R of labels().
  const gpu::Texture& shares() const;
  static constexpr int kMostMovers = 3;
  /// Where virtual models are to be hidden, since a mover is before them (FrontMovers). Nothing if
  /// the last frame had no models.
  std::optional<scene::ModelCover> cover() const;
  /// RGBA16F, LINEAR, as large: the background's mean colour, sRGB-coded, also behind movers; and
  /// the number of frames in it, 0 where it was never seen.
  const gpu::Texture& background() const;
  /// R32F, as large: how dynamic the background is, as leaves in the wind are
  /// (shaders/background_activity.glsl).
  const gpu::Texture& activity() const;
  static constexpr int kCellPixels = 2;
  /// Waits for the GPU and reads labels(), for measures: grey, 255 on movers, a pixel for each
  /// texel. Throws hal::Failure (kUnsupported) where the GPU cannot read such a texture.
  hal::Image readMovers() const;

  /// RGBA16F; a texel is kBlockCells² cells, of the movers 1 to kMostMovers one above the other.
  /// RG: displacement of the mover since the previous frame, less the background's, px of
  /// the full image, times their weight; B: that weight.
  const gpu::Texture& moverMotion() const;
  static constexpr int kBlockCells = 8;
  /// RGBA16F; a texel is a block: how far what is seen there has gone lately, before a
  /// camera that stands (shaders/mover_displacement.glsl).
  const gpu::Texture& displacements() const;

  /// Whether the camera has stood since the previous frame, so that all the background rests; and
  /// whether it has within the last half second, so that one nudge changes no strokes.
  bool isStanding() const;
  bool hasStood() const;

  /// Forgets the past.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
