#pragma once

#include <cstdint>
#include <vector>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/media/handles.h"

namespace pleinair::hal::libav {

/// Encodes pictures of one format as PNG, quickly rather than small. One thread.
class PngEncoder {
 public:
  /// For RGB8, RGBA8 or grey. Errors: kUnsupported (format, or no encoder in this libav).
  static Result<PngEncoder> open(FrameFormat format);

  /// The bytes of a whole PNG file. Precondition: `picture` is complete and of open()'s format.
  Result<std::vector<std::uint8_t>> encode(const ImageView& picture);

 private:
  PngEncoder(CodecContext codec, FrameFormat format);
  CodecContext codec_;
  FrameFormat format_;
  Packet packet_;
};

}  // namespace pleinair::hal::libav
