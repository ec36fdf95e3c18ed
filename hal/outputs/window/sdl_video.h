#pragma once

#include "hal/error.h"

namespace pleinair::hal::window {

/// SDL's video part, for as long as one of these lives. SDL wants its windows and events on one
/// thread: all of these are made, used and destroyed on that of the first, which is asserted.
class SdlVideo {
 public:
  /// Errors: kNotFound (there is no display, or none that SDL can use).
  static Result<SdlVideo> open();

  SdlVideo(SdlVideo&& other) noexcept;
  SdlVideo& operator=(SdlVideo&&) = delete;
  SdlVideo(const SdlVideo&) = delete;
  SdlVideo& operator=(const SdlVideo&) = delete;
  ~SdlVideo();

  static bool isOnItsThread();

 private:
  SdlVideo() = default;
  bool isOpen_ = true;
};

}  // namespace pleinair::hal::window
