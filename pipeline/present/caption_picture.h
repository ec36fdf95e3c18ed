#pragma once

#include <string>

#include "hal/image.h"

namespace pleinair::present {

/// A picture that lies over another one, `left` and `top` px from its corner.
struct CaptionPicture {
  hal::Image image;  ///< RGBA8, its alpha not multiplied in; without a pixel: there is no room
  int left = 0;
  int top = 0;
};

/// Lines of white text on a dark band in the upper left corner of a picture of `size`, since the
/// text of waiting pictures stands below; '\t' goes to a second column. Letters are as large as can
/// be read from where the whole picture is looked at, smaller where there are many lines. A line
/// that is too long is wrapped; of more lines than find room the last ones are left out. Any one
/// thread.
CaptionPicture captionPicture(const std::string& text, hal::FrameSize size);

}  // namespace pleinair::present
