#pragma once

#include <string>

#include "hal/outputs/window/sdl_video.h"

namespace pleinair::hal::window {

/// Lines on a dark band over the lower left corner of a renderer's picture.
class Caption {
 public:
  void set(const std::string& text, double opacity);
  /// `pixelScale`: pixels of the screen to one of the desktop's units.
  void draw(SDL_Renderer* renderer, double pixelScale);
  /// Leaves the texture to the process's end: SDL may not be called any more.
  void abandon() { static_cast<void>(texture_.release()); }

 private:
  /// A texture of the text, kept until it has to be another.
  void prepare(SDL_Renderer* renderer, int fontPixels, int mostWidth);

  std::string text_;
  double opacity_ = 0.0;
  TextureHandle texture_;  ///< white, its alpha is the text's
  int fontPixels_ = 0;
  int mostWidth_ = 0;
};

}  // namespace pleinair::hal::window
