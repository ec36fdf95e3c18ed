#pragma once

#include <memory>

#include <SDL.h>

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

struct SdlDeleter {
  void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
  void operator()(SDL_Renderer* renderer) const { SDL_DestroyRenderer(renderer); }
  void operator()(SDL_Texture* texture) const { SDL_DestroyTexture(texture); }
};
using WindowHandle = std::unique_ptr<SDL_Window, SdlDeleter>;
using RendererHandle = std::unique_ptr<SDL_Renderer, SdlDeleter>;
/// To be destroyed before its renderer, which takes it along otherwise.
using TextureHandle = std::unique_ptr<SDL_Texture, SdlDeleter>;

/// Watches the connection to the X server, whose end would otherwise end the process: Xlib calls
/// exit() when it meets it. All windows share one connection, which cannot be had again: once it is
/// lost, nothing of SDL's may be called any more, and what SDL holds is left to the process's end.
/// Other display servers are not watched. All on SDL's thread.
namespace display_connection {

/// Starts with the opening of a window. Idempotent.
void watch(SDL_Window* window);
/// False on an X server where nobody could make the window fill the screen.
bool hasWindowManager(SDL_Window* window);
/// Ends the watch, before SDL closes the connection.
void forget();
/// Polls the connection at each call.
bool isLost();

}  // namespace display_connection

}  // namespace pleinair::hal::window
