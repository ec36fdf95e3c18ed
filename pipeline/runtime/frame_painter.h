#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "hal/captured_frame.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/pixel_format.h"
#include "pipeline/engine/painter.h"

namespace pleinair::runtime {

/// What live frames are painted with: the engine's Painter, or a test's. Paint thread only, from
/// its making to its destruction.
class FramePainter {
 public:
  virtual ~FramePainter() = default;
  FramePainter() = default;
  FramePainter(const FramePainter&) = delete;
  FramePainter& operator=(const FramePainter&) = delete;

  /// Begins to paint `frame` at a level of quality (0: the best), for each of its outputs. Errors:
  /// kDeviceLost: nothing comes out of this painter any more, and a new one is needed; others: this
  /// frame could not be painted.
  virtual hal::Result<void> paint(const hal::CapturedFrame& frame, std::size_t quality) = 0;
  /// Copies an output's oldest finished picture into `picture`, whose memory is reused; false if
  /// none is ready. Never waits. Errors: kDeviceLost.
  virtual hal::Answer poll(std::size_t output, OutputFrame& picture) = 0;
  /// Returns once a picture in flight can be polled, or `limit` of real time is over. An error
  /// shows in the next poll(). Precondition: one is in flight.
  virtual void wait(hal::Duration limit) = 0;

  /// Begins another output: from the next frame on its pictures are brought to memory in `format`.
  /// `output`: the next number after those that there were. Throws hal::Failure.
  virtual void open(std::size_t output, const hal::FrameFormat& format) = 0;
  /// Ends an output: its pictures that were not taken are dropped.
  virtual void close(std::size_t output) = 0;

  /// The times of the painter's passes in the frames that were timed; valid until the next paint().
  virtual std::span<const gpu::PassTime> passTimes() const { return {}; }
};

/// Makes a painter that brings its pictures to memory in these formats, one an output, numbered
/// from 0. Throws hal::Failure.
using PainterFactory =
    std::function<std::unique_ptr<FramePainter>(const std::vector<hal::FrameFormat>& outputs)>;

}  // namespace pleinair::runtime
