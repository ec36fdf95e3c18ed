#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/cameras/libcamera/library.h"
#include "hal/error.h"
#include "hal/image.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::libcamera {

/// A pixel format of libcamera, by its DRM fourcc.
struct FrameLayout {
  std::uint32_t fourcc = 0;
  PixelFormat pixelFormat = PixelFormat::kNv12;  ///< of the frames that are delivered
  /// Bytes a pixel in memory whose red and blue are exchanged on the processor; 0: lent as it is.
  int swappedBytes = 0;
};

/// The supported formats, the one that is cheapest to paint first.
std::span<const FrameLayout> frameLayouts();
/// Those of a second image whose first plane is luma, the one with the fewest bytes first.
std::span<const std::uint32_t> lumaFourccs();
/// The size of a second image of a frame, of the same shape, with even sides: the longer one of
/// `sidePx`. Nothing where the frame is no larger.
std::optional<FrameSize> lumaSizeFor(FrameSize frame, int sidePx);
/// Whether an image of this size shows the same part of the view as the frame, which is larger: its
/// shape is the frame's, to a px of the image.
bool isReduced(FrameSize image, FrameSize frame);
/// "NV12"; bytes that are no letters as "?".
std::string fourccName(std::uint32_t fourcc);
/// Null if it is not supported.
const FrameLayout* findLayout(std::uint32_t fourcc);

/// The format and size to ask for: the requested pixel format if it is offered, else the first of
/// frameLayouts(); the requested size if an offered one covers it, else the offered one nearest to
/// it, and without a request the largest. libcamera may still change the size. Errors:
/// kUnsupported, with what is offered.
Result<StreamWish> chooseFormat(std::span<const OfferedFormat> offered,
                                std::optional<FrameSize> size, std::optional<PixelFormat> format);

/// The planes of a frame in a buffer: separate ones, or one after the other in the first. Nothing
/// if the buffer does not hold them. Planes of `swappedBytes` formats stay as they are in memory.
std::optional<std::array<PlaneView, 3>> planesIn(const BufferMemory& memory,
                                                 const FrameLayout& layout, FrameSize size,
                                                 std::size_t strideBytes);

/// Whether the driver has filled all of these planes of the memory, by the bytes that it has used
/// of each memory plane.
bool isFilled(const std::array<std::size_t, 3>& usedBytes, const BufferMemory& memory,
              const FrameLayout& layout, const std::array<PlaneView, 3>& planes);

/// Copies an image of blue, green, red (and one more byte) to RGB8. Precondition: `from` holds
/// to.size() at its stride.
void swapToRgb(const PlaneView& from, int bytesPerPixel, Image& to);

}  // namespace pleinair::hal::libcamera
