#pragma once

#include <memory>

#include "hal/media/picture_encoder.h"

namespace pleinair::hal {

/// TIFF by libtiff, with LZW; format RGB8.
std::unique_ptr<PictureEncoder> makeTiffEncoder(FrameFormat format,
                                                const PictureFileOptions& options);

}  // namespace pleinair::hal
