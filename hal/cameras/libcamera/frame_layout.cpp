#include "hal/cameras/libcamera/frame_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

namespace pleinair::hal::libcamera {
namespace {

constexpr std::uint32_t fourccOf(const char (&text)[5]) {
  std::uint32_t code = 0;
  for (int i = 0; i < 4; ++i) code |= std::uint32_t{static_cast<std::uint8_t>(text[i])} << 8 * i;
  return code;
}

// DRM names RGB formats from the highest byte of a little-endian word: "BGR888" is R, G, B in
// memory.
constexpr std::array<FrameLayout, 8> kLayouts{{
    {fourccOf("NV12"), PixelFormat::kNv12, 0},
    {fourccOf("YU12"), PixelFormat::kI420, 0},
    {fourccOf("YUYV"), PixelFormat::kYuyv, 0},
    {fourccOf("BG24"), PixelFormat::kRgb8, 0},  // BGR888
    {fourccOf("RG24"), PixelFormat::kRgb8, 3},  // RGB888
    {fourccOf("XR24"), PixelFormat::kRgb8, 4},  // XRGB8888
    {fourccOf("AR24"), PixelFormat::kRgb8, 4},  // ARGB8888
    {fourccOf("R8  "), PixelFormat::kGrey8, 0},
}};

std::int64_t distance(FrameSize a, FrameSize b) {
  return std::int64_t{std::abs(a.width - b.width)} + std::abs(a.height - b.height);
}

FrameSize nearestSize(const std::vector<FrameSize>& sizes, std::optional<FrameSize> wanted) {
  if (!wanted)
    return sizes.empty() ? FrameSize{640, 480} : std::ranges::max(sizes, {}, &FrameSize::pixels);
  if (sizes.empty()) return *wanted;
  // A size within the smallest and the largest is asked for as it is: libcamera lists examples of
  // what a sensor and its scaler can do, and adjusts the rest.
  const auto coversAll = std::ranges::any_of(sizes, [&](FrameSize each) {
    return each.width >= wanted->width && each.height >= wanted->height;
  });
  if (coversAll) return *wanted;
  return *std::ranges::min_element(sizes, {},
                                   [&](FrameSize each) { return distance(each, *wanted); });
}

std::size_t chromaStride(PixelFormat format, int plane, std::size_t strideBytes) {
  return plane > 0 && format == PixelFormat::kI420 ? strideBytes / 2 : strideBytes;
}

}  // namespace

std::span<const FrameLayout> frameLayouts() {
  return kLayouts;
}

std::span<const std::uint32_t> lumaFourccs() {
  static constexpr std::array kFourccs{fourccOf("R8  "), fourccOf("YU12"), fourccOf("NV12")};
  return kFourccs;
}

std::optional<FrameSize> lumaSizeFor(FrameSize frame, int sidePx) {
  const int longer = std::max(frame.width, frame.height);
  if (sidePx < 2 || longer <= sidePx) return std::nullopt;
  const auto even = [&](int side) {
    return std::max(2, 2 * static_cast<int>(std::lround(0.5 * side * sidePx / longer)));
  };
  return FrameSize{even(frame.width), even(frame.height)};
}

bool isReduced(FrameSize image, FrameSize frame) {
  if (image.width <= 0 || image.height <= 0) return false;
  if (image.width > frame.width || image.height > frame.height || image == frame) return false;
  return std::abs(std::int64_t{image.width} * frame.height -
                  std::int64_t{image.height} * frame.width) <= std::max(frame.width, frame.height);
}

std::string fourccName(std::uint32_t fourcc) {
  std::string text;
  for (int i = 0; i < 4; ++i) {
    const char letter = static_cast<char>(fourcc >> 8 * i & 0xFF);
    text += letter >= ' ' && letter <= '~' ? letter : '?';
  }
  return text;
}

const FrameLayout* findLayout(std::uint32_t fourcc) {
  const auto* const found = std::ranges::find(kLayouts, fourcc, &FrameLayout::fourcc);
  return found == kLayouts.end() ? nullptr : found;
}

Result<StreamWish> chooseFormat(std::span<const OfferedFormat> offered,
                                std::optional<FrameSize> size, std::optional<PixelFormat> format) {
  const OfferedFormat* chosen = nullptr;
  bool isAsWanted = false;
  for (const FrameLayout& layout : kLayouts) {
    const auto found = std::ranges::find(offered, layout.fourcc, &OfferedFormat::fourcc);
    if (found == offered.end()) continue;
    const bool isWanted = format && layout.pixelFormat == *format;
    if (chosen != nullptr && (isAsWanted || !isWanted)) continue;
    chosen = &*found;
    isAsWanted = isWanted;
  }
  if (chosen != nullptr) {
    return StreamWish{.fourcc = chosen->fourcc, .size = nearestSize(chosen->sizes, size)};
  }
  std::string all;
  for (const OfferedFormat& each : offered)
    all += (all.empty() ? "" : ", ") + fourccName(each.fourcc);
  return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                              .problem = "has no pixel format that can be read",
                              .remedy = all.empty()
                                            ? "it offers none"
                                            : "it offers " + all +
                                                  "; raw Bayer needs an image processor that "
                                                  "libcamera drives"});
}

std::optional<std::array<PlaneView, 3>> planesIn(const BufferMemory& memory,
                                                 const FrameLayout& layout, FrameSize size,
                                                 std::size_t strideBytes) {
  const int count = planeCount(layout.pixelFormat);
  const bool isSeparate = memory.planeCount >= count;
  std::array<PlaneView, 3> planes;
  std::size_t offset = 0;
  for (int i = 0; i < count; ++i) {
    const std::size_t stride = chromaStride(layout.pixelFormat, i, strideBytes);
    const auto rows = static_cast<std::size_t>(planeRows(layout.pixelFormat, i, size.height));
    const std::size_t row =
        layout.swappedBytes > 0
            ? static_cast<std::size_t>(layout.swappedBytes) * static_cast<std::size_t>(size.width)
            : rowBytes(layout.pixelFormat, i, size.width);
    const std::span<const std::uint8_t> bytes =
        memory.planes.at(isSeparate ? static_cast<std::size_t>(i) : 0);
    // Beyond the memory, products would overflow.
    if (row > stride || rows == 0 || stride > bytes.size()) return std::nullopt;
    const std::size_t needed = stride * (rows - 1) + row;
    const std::size_t begin = isSeparate ? 0 : offset;
    if (begin > bytes.size() || needed > bytes.size() - begin) return std::nullopt;
    planes.at(static_cast<std::size_t>(i)) = {.bytes = bytes.subspan(begin, needed),
                                              .strideBytes = stride};
    offset += stride * rows;
  }
  return planes;
}

bool isFilled(const std::array<std::size_t, 3>& usedBytes, const BufferMemory& memory,
              const FrameLayout& layout, const std::array<PlaneView, 3>& planes) {
  const int count = planeCount(layout.pixelFormat);
  const bool isSeparate = memory.planeCount >= count;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const std::size_t in = isSeparate ? at : 0;
    const auto begin =
        static_cast<std::size_t>(planes.at(at).bytes.data() - memory.planes.at(in).data());
    if (usedBytes.at(in) < begin + planes.at(at).bytes.size()) return false;
  }
  return true;
}

void swapToRgb(const PlaneView& from, int bytesPerPixel, Image& to) {
  const auto step = static_cast<std::size_t>(bytesPerPixel);
  for (int y = 0; y < to.size().height; ++y) {
    const std::uint8_t* source = from.bytes.data() + static_cast<std::size_t>(y) * from.strideBytes;
    const std::span<std::uint8_t> row = to.row(0, y);
    for (std::size_t x = 0; x + 2 < row.size(); x += 3, source += step) {
      row[x] = source[2];
      row[x + 1] = source[1];
      row[x + 2] = source[0];
    }
  }
}

}  // namespace pleinair::hal::libcamera
