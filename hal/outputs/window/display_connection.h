#pragma once

#include <SDL.h>

namespace pleinair::hal::window {

/// Watches the connection to the X server, whose end would otherwise end the process: Xlib calls
/// exit() when it meets it. All windows share one connection, which cannot be had again: once it is
/// lost, nothing of SDL's may be called any more, and what SDL holds is left to the process's end.
/// Other display servers are not watched. All on SDL's thread.
namespace display_connection {

/// Starts with the opening of a window. Idempotent.
void watch(SDL_Window* window);
/// Ends the watch, before SDL closes the connection.
void forget();
/// Polls the connection at each call.
bool isLost();

}  // namespace display_connection
}  // namespace pleinair::hal::window
