// Bytes as a picture file: signature, header, decoder, conversion, orientation.
#include <optional>
#include <span>

#include "hal/libav/picture_file.h"
#include "hal/libav/picture_header.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

/// Larger ones within the limits are sound and slow, and teach nothing new.
constexpr std::int64_t kMostPixels = 1'000'000;

bool isSlow(std::span<const std::uint8_t> bytes) {
  const auto kind = hal::libav::pictureKindOf(bytes);
  if (!kind) return false;
  const std::optional<hal::FrameSize> size = hal::libav::peekPictureSize(*kind, bytes);
  return size && hal::isAcceptedSize(*size) && size->pixels() > kMostPixels;
}

void read(const hal::Result<hal::Image>& picture) {
  if (picture) {
    fuzz::touch(picture->view());
  } else {
    fuzz::expectOneLine(picture.error().message());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (isSlow({data, size})) return -1;
  const fuzz::MemoryFile file(data, size);
  read(hal::readPicture(file.path()));
  read(hal::readPictureRgb(file.path()));
  return 0;
}
