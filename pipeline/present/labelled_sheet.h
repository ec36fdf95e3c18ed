#pragma once

#include <span>
#include <string>

#include "hal/image.h"

namespace pleinair::present {

struct LabelledImage {
  hal::Image image;   ///< RGB8
  std::string label;  ///< UTF-8, below the image
};

/// RGB8: images in reading order on white, each with its label below, `columns` in a row. All
/// images have the size of the first. Precondition: there is one; columns ≥ 1.
hal::Image labelledSheet(std::span<const LabelledImage> images, int columns);

}  // namespace pleinair::present
