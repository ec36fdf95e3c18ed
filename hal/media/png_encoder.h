#pragma once

#include <cstdint>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/media/handles.h"

namespace pleinair::hal::libav {

/// Encodes images of one format as PNG, optimized for speed rather than size. One thread.
class PngEncoder {
 public:
  /// For RGB8, RGBA8 or grey. Errors: kUnsupported (format, or libav without a PNG encoder).
  static Result<PngEncoder> open(FrameFormat format);

  /// Gives a whole PNG file. Precondition: `picture` is complete and has open()'s format.
  Result<std::vector<std::uint8_t>> encode(const ImageView& picture);

 private:
  PngEncoder(CodecContext codec, FrameFormat format);
  CodecContext codec_;
  FrameFormat format_;
  Packet packet_;
};

}  // namespace pleinair::hal::libav
