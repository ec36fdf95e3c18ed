#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "hal/clock.h"
#include "hal/pixel_format.h"
#include "pipeline/gpu/buffer.h"
#include "pipeline/gpu/shader_library.h"
#include "pipeline/marks/anchor.h"
#include "pipeline/marks/motion_field.h"
#include "pipeline/scene/render/ar_frame.h"

namespace pleinair::marks {

/// How many anchors there are (thesis §5.3, with hysteresis): a cell of the grid with fewer than
/// `birthBelow` is filled up to `target`; one with more than `deathAbove` loses one a frame. What
/// lies between changes nothing, which is what keeps the turnover low. Of a cell that shows both
/// models and the camera's picture, each has its share.
struct DensityRule {
  int cellPixels = 8;  ///< the cell's side, in px of the full picture
  int target = 2;
  int birthBelow = 1;
  int deathAbove = 4;
};

struct AnchorOptions {
  DensityRule density;
  unsigned seed = 1;  ///< of all that is random
};

/// How anchors hold on from frame to frame; may change with each.
struct AnchorHold {
  hal::Duration fadeIn = std::chrono::milliseconds(300);   ///< from nothing to all; 0: at once
  hal::Duration fadeOut = std::chrono::milliseconds(200);  ///< from all to nothing; likewise
  bool hasSlack = true;  ///< DensityRule's about its target; else births and deaths keep to that
};

/// The anchors of a style's marks: born where the picture has too few, carried with what they lie
/// on (a surface of a model, exactly; else the image, by the best that is known of its motion),
/// faded out where what they lie on is hidden and where they crowd. Each has a slot of its own as
/// long as it lives, so that styles keep what they know of a mark in buffers beside it. All on the
/// GPU, nothing is read back; the same frames with the same times give the same anchors. All calls
/// on the thread of the GL context it was made in.
class AnchorSet {
 public:
  /// `library` has gpu::marksShaders(), gpu::sceneShaders() and gpu::gpuShaders(). Pictures'
  /// full size is `full`. Throws hal::Failure where the GPU has no memory for them.
  AnchorSet(const gpu::ShaderLibrary& library, hal::FrameSize full, AnchorOptions options);
  ~AnchorSet();
  AnchorSet(const AnchorSet&) = delete;
  AnchorSet& operator=(const AnchorSet&) = delete;
  AnchorSet(AnchorSet&&) = delete;
  AnchorSet& operator=(AnchorSet&&) = delete;

  /// Goes on to the next frame, whose `motion` has been updated. The first frame, one after
  /// reset(), and one after a cut begins anew, with all anchors there at once. Preconditions:
  /// frame.full() is the constructor's size; the style's needs() ask for surfaces and
  /// measuredMotion.
  void advance(const scene::ArFrame& frame, const MotionField& motion, const AnchorHold& hold = {});
  /// Whether the last advance() began anew: what styles keep of slots is of other anchors.
  bool hasBegunAnew() const;

  /// slotCount() Anchors; those that are not alive are free slots.
  const gpu::Buffer& anchors() const;
  std::uint32_t slotCount() const;
  const AnchorOptions& options() const;

  /// Waits for the GPU and reads all slots: for measures and tests. All are free where a lost GPU
  /// has nothing to read.
  std::vector<Anchor> read() const;

  /// The next advance() begins anew, with other anchors than ever before.
  void beginAnew();
  /// Forgets all: the next advance() begins anew, with the anchors of a first frame.
  void reset();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pleinair::marks
