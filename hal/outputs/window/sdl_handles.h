#pragma once

#include <memory>

#include <SDL.h>

namespace pleinair::hal::window {

struct SdlDeleter {
  void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
  void operator()(SDL_Renderer* renderer) const { SDL_DestroyRenderer(renderer); }
  void operator()(SDL_Texture* texture) const { SDL_DestroyTexture(texture); }
};
using WindowHandle = std::unique_ptr<SDL_Window, SdlDeleter>;
using RendererHandle = std::unique_ptr<SDL_Renderer, SdlDeleter>;
/// To be destroyed before its renderer, which takes it along otherwise.
using TextureHandle = std::unique_ptr<SDL_Texture, SdlDeleter>;

}  // namespace pleinair::hal::window
