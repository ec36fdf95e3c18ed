#pragma once

#include <memory>

#include "hal/media/picture_encoder.h"

namespace pleinair::hal {

/// JPEG by libjpeg; format RGB8.
std::unique_ptr<PictureEncoder> makeJpegEncoder(FrameFormat format,
                                                const PictureFileOptions& options);

}  // namespace pleinair::hal
