#include "hal/surface.h"

#include <algorithm>
#include <string>
#include <string_view>

#include <poll.h>
#include <unistd.h>

namespace pleinair::hal {
namespace {

constexpr std::size_t kPixelBytes = 4;

void copyRow(std::span<const std::uint8_t> rgba, std::span<std::uint8_t> row,
             bool swapsRedAndBlue) {
  if (!swapsRedAndBlue) {
    std::ranges::copy(rgba, row.begin());
    return;
  }
  for (std::size_t i = 0; i < rgba.size(); i += kPixelBytes) {
    row[i] = rgba[i + 2];
    row[i + 1] = rgba[i + 1];
    row[i + 2] = rgba[i];
    row[i + 3] = rgba[i + 3];
  }
}

Error refusal(ErrorKind kind, std::string problem) {
  return {.kind = kind, .subject = "surface", .problem = std::move(problem), .remedy = {}};
}

}  // namespace

std::string layoutText(std::uint64_t modifier) {
  if (modifier == kLinearModifier) return "rows (linear)";
  constexpr int kDigits = 16;
  constexpr std::string_view kHex = "0123456789abcdef";
  std::string text = "modifier 0x";
  for (int digit = kDigits - 1; digit >= 0; --digit) {
    text += kHex[static_cast<std::size_t>(modifier >> (4 * digit) & 15U)];
  }
  return text;
}

bool Fence::hasSignalled() const {
  if (syncFile_ < 0) return true;
  pollfd file{.fd = syncFile_, .events = POLLIN, .revents = 0};
  return ::poll(&file, 1, 0) == 1;
}

Fence::~Fence() {
  if (syncFile_ >= 0) ::close(syncFile_);
}

Result<void> copyToSurface(const ImageView& picture, const Surface& surface,
                           const SurfaceMapping& mapping) {
  const bool swaps = surface.fourcc == kXrgb8888 || surface.fourcc == kArgb8888;
  const bool keeps = surface.fourcc == kXbgr8888 || surface.fourcc == kAbgr8888;
  const bool isRgba = picture.format.pixelFormat == PixelFormat::kRgba8;
  if ((!swaps && !keeps) || surface.modifier != kLinearModifier || !isRgba) {
    return tl::unexpected(refusal(ErrorKind::kUnsupported, "takes no copy of this picture"));
  }
  const FrameSize size = picture.format.size;
  const std::size_t rowBytes = static_cast<std::size_t>(size.width) * kPixelBytes;
  const std::size_t stride = surface.planes[0].strideBytes;
  const std::span<std::uint8_t> bytes = mapping.plane(0);
  const bool isLargeEnough =
      stride >= rowBytes &&
      bytes.size() >= stride * static_cast<std::size_t>(size.height - 1) + rowBytes;
  if (size != surface.format.size || !isLargeEnough) {
    return tl::unexpected(refusal(ErrorKind::kInvalidArgument, "has another size"));
  }
  for (int y = 0; y < size.height; ++y) {
    copyRow(picture.row(0, y), bytes.subspan(static_cast<std::size_t>(y) * stride, rowBytes),
            swaps);
  }
  return {};
}

}  // namespace pleinair::hal
