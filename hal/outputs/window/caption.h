#pragma once

#include <string>

#include "hal/image.h"
#include "hal/outputs/window/sdl_video.h"

namespace pleinair::hal::window {

/// Lines of UTF-8 (what is not is replaced) in the desktop's sans-serif font, as coverage: a grey
/// picture as large as the text needs, 0 without ink and 255 within it. '\t' goes to a second
/// column. Lines that are wider than `mostWidth` pixels are cut with an ellipsis. Any one thread.
Image captionPicture(const std::string& text, int fontPixels, int mostWidth);

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
