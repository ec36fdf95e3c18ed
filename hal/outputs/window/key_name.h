#pragma once

#include <string>

#include <SDL_keyboard.h>

namespace pleinair::hal::window {

/// KeyPressed::name of a key; empty for one that has none, or that is the desktop's.
std::string keyName(const SDL_Keysym& key);

}  // namespace pleinair::hal::window
