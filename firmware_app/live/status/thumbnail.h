#pragma once

#include <string>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::app {

/// The longer side of a thumbnail, in pixels.
inline constexpr int kThumbnailSide = 480;

/// A small picture of an output's frame, upright, as a JPEG. `quarterTurns`: how far the frame is
/// turned clockwise. Errors: kUnsupported (Bayer). Any thread.
hal::Result<std::string> thumbnailJpeg(const hal::Image& frame, int quarterTurns);

}  // namespace pleinair::app
