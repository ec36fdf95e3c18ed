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
  /// the number of outputs opened so far. Throws hal::Failure.
  virtual void open(std::size_t output, const hal::OutputFormat& format) = 0;
  /// Closes an output; its frames in flight are dropped.
  virtual void close(std::size_t output) = 0;

  /// Times of the painter's passes in the timed frames; valid until the next paint().
  virtual std::span<const gpu::PassTime> passTimes() const { return {}; }
};

/// Makes a painter with an open output for each format, numbered from 0. Throws hal::Failure.
using PainterFactory =
    std::function<std::unique_ptr<FramePainter>(const std::vector<hal::OutputFormat>& outputs)>;

}  // namespace pleinair::runtime
