#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "hal/clock.h"
#include "pipeline/gpu/texture.h"
#include "pipeline/overlay/overlay_content.h"

namespace pleinair::overlay {

/// The index of the frame that a movie shows so long after its beginning, in the round that it is
/// in then.
std::size_t frameAt(const PanelMovie& movie, hal::Duration sinceItBegan);

/// A movie on the GPU: one texture, into which each frame is uploaded when it is due. All calls on
/// the thread of the GL context.
class MoviePlayer {
 public:
  /// Takes another movie, or none, which begins with the next frame that is asked for; the same one
  /// plays on. Allocates.
  void take(const std::shared_ptr<const PanelMovie>& movie);
  explicit operator bool() const { return movie_ != nullptr; }
  /// The frame for that time. Allocates nothing. Precondition: there is a movie.
  const gpu::Texture& at(hal::TimePoint now);

 private:
  std::shared_ptr<const PanelMovie> movie_;
  gpu::Texture texture_;
  std::optional<hal::TimePoint> began_;
  std::optional<std::size_t> uploaded_;  ///< the frame in the texture
};

}  // namespace pleinair::overlay
