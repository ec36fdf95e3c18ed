#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/output.h"
#include "pipeline/engine/painter.h"
#include "pipeline/runtime/output/surface_lending.h"

namespace pleinair::runtime {

/// The painter of live frames: the engine's Painter, or a test's. It is created, used and destroyed
/// on the paint thread.
class FramePainter {
 public:
  virtual ~FramePainter() = default;
  FramePainter() = default;
  FramePainter(const FramePainter&) = delete;
  FramePainter& operator=(const FramePainter&) = delete;

  /// Begins to paint `frame` for each open output at a quality level (0: the best). Errors:
  /// kDeviceLost, after which a new painter is needed; others: this frame could not be painted.
  virtual hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t quality) = 0;
  /// Copies an output's oldest finished frame into `frame`, whose memory is reused; false if none
  /// is ready. Never waits. Errors: kDeviceLost.
  virtual hal::Answer poll(std::size_t output, OutputFrame& frame) = 0;
  /// Returns once a frame in flight can be polled, or after `limit` of real time. The next poll()
  /// gives any error. Precondition: one is in flight.
  virtual void wait(hal::Duration limit) = 0;

  /// Opens an output: from the next paint() on, frames are read back for it in `format`. `output`:
  /// the number of outputs opened so far. Throws hal::Failure: kDeviceLost, after which a new
  /// painter is needed; others: this output cannot be painted for, and is not opened.
  virtual void open(std::size_t output, const hal::OutputFormat& format) = 0;
  /// Closes an output; its frames in flight are dropped.
  virtual void close(std::size_t output) = 0;

  // Painters that draw straight into the memory that a display scans out.

  /// The layouts that it draws into; none by default.
  virtual DrawableLayouts drawable() {
    return {.modifiers = {}, .problem = "draws into memory only"};
  }
  /// Takes the surfaces that an output lends, in place of those of an earlier loan, and draws the
  /// pattern (hal::surfacePatternAt()) into each. Waits for the GPU. Errors: kTimeout (not yet: to
  /// be called again), kUnsupported, kDeviceLost.
  virtual hal::Result<void> importLoan(std::size_t /*output*/, const SurfaceLoan& /*loan*/) {
    return tl::unexpected(hal::Error{.kind = hal::ErrorKind::kUnsupported,
                                     .subject = "painter",
                                     .problem = drawable().problem,
                                     .remedy = {}});
  }
  /// Draws the next frame into this surface of its last loan, for that output, instead of reading
  /// it back.
  virtual void drawNextInto(std::size_t /*output*/, const hal::LentSurface& /*surface*/) {}

  /// How camera frames reach the GPU and the trackers; null: it is not known. Valid until the next
  /// paint().
  virtual const CameraPath* cameraPath() const { return nullptr; }

  /// Times of the painter's passes in the timed frames; valid until the next paint().
  virtual std::span<const gpu::PassTime> passTimes() const { return {}; }
};

/// Makes a painter without outputs. Throws hal::Failure.
using PainterFactory = std::function<std::unique_ptr<FramePainter>()>;

}  // namespace pleinair::runtime
