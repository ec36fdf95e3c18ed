#pragma once

#include <algorithm>
#include <string>

#include <SDL_keyboard.h>

namespace pleinair::hal::window {

/// KeyPressed::name of a key; empty for one that has none, or that is the desktop's.
inline std::string keyName(const SDL_Keysym& key) {
  constexpr int kDesktops = KMOD_CTRL | KMOD_ALT | KMOD_GUI;
  if ((key.mod & kDesktops) != 0) return {};
  const bool isShifted = (key.mod & KMOD_SHIFT) != 0;
  if (key.sym == SDLK_QUESTION || (key.sym == SDLK_SLASH && isShifted)) return "?";
  std::string name = SDL_GetKeyName(key.sym);
  std::ranges::transform(name, name.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return name;
}

}  // namespace pleinair::hal::window
