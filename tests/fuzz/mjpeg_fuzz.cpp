// Decodes bytes as a camera's JPEG, and converts chroma of any density to 4:2:0.
#include <optional>
#include <span>

#include "hal/media/motion_jpeg.h"
#include "hal/media/picture_header.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

/// Larger images within the limits are valid and slow, and find nothing new.
constexpr std::int64_t kMaxPixels = 1'000'000;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  const auto picture = hal::peekPictureSize(hal::PictureKind::kJpeg, bytes);
  if (picture && hal::isAcceptedSize(*picture) && picture->pixels() > kMaxPixels) return -1;
  const auto decoded = hal::libav::decodeMotionJpeg(bytes, "camera");
  if (!decoded) {
    fuzz::expectOneLine(decoded.error().message());
    return -1;
  }
  if (decoded->view.format.pixelFormat != hal::PixelFormat::kI420) fuzz::fail("not I420");
  fuzz::touch(decoded->view);
  return 0;
}
