#pragma once

#include <string>

#include "hal/image.h"

namespace pleinair::hal::window {

/// Lines of UTF-8 (what is not is replaced) in the desktop's sans-serif font, as coverage: a grey
/// picture as large as the text needs, 0 without ink and 255 within it. '\t' goes to a second
/// column. Lines that are wider than `mostWidth` pixels are cut with an ellipsis. Any one thread.
Image captionPicture(const std::string& text, int fontPixels, int mostWidth);

}  // namespace pleinair::hal::window
