#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "hal/error.h"
#include "hal/media/handles.h"

namespace pleinair::hal::libav {

/// Decodes the primary image of a HEIC or AVIF file in memory to RGB24 or RGBA, or to RGB48 or
/// RGBA64 where it has more than 8 bits, by libheif: upright, with the colour space of its nclx
/// box. `subject` names it in errors: kInvalidInput (broken), kUnsupported (size, coding, or built
/// without libheif).
Result<std::shared_ptr<const AVFrame>> decodeHeif(std::span<const std::uint8_t> bytes,
                                                  const std::string& subject);

}  // namespace pleinair::hal::libav
