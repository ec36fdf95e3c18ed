#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pipeline/engine/painter.h"
#include "pipeline/present/readback.h"
#include "pipeline/present/surface_drawer.h"

namespace pleinair {

/// A read-back with the origins of its output frames in flight. Paint thread only, with the
/// painter's context current.
struct OpenReadback {
  struct Stamp {
    std::uint64_t sequence = 0;
    hal::TimePoint captureTime;
    std::uint64_t painting = 0;               ///< number of the painting, whatever its frame
    std::optional<hal::LentSurface> surface;  ///< that it is drawn into; unset: read back
  };
  OpenReadback(present::Readback readback, int turns)
      : ring(std::move(readback)), quarterTurns(turns) {}

  /// Submits a picture, into `next` if that is set; skips it if there is no room.
  void submit(const gpu::Texture& picture, hal::FrameSize size, Stamp stamp);
  /// Whether the oldest output frame is finished within `limit`. Precondition: one is in flight.
  hal::Answer isReadyWithin(hal::Duration limit) const;
  /// Takes the oldest output frame, if it is finished (surfaces: within `limit`), and leaves its
  /// stamp in flight: the surface that it was drawn into, or its pixels by `copy`, which is
  /// present::Readback's poll() or wait(). Errors are those of the GPU.
  hal::Answer take(OutputFrame& frame, hal::Answer (present::Readback::*copy)(hal::Image&),
                   hal::Duration limit);

  present::Readback ring;
  int quarterTurns;
  std::optional<present::SurfaceDrawer> drawer;  ///< once surfaces were imported
  std::optional<hal::LentSurface> next;          ///< for the next picture
  std::vector<Stamp> inFlight;                   ///< oldest first
  std::uint64_t skipped = 0;
};

}  // namespace pleinair
