#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include <linux/videodev2.h>

#include "hal/error.h"
#include "hal/image.h"
#include "hal/output.h"
#include "hal/pixel_format.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::loopback {

/// Where the planes of one picture lie in the bytes that a single-planar V4L2 device takes: one
/// after the other; chroma of NV12 has luma's stride, Cb and Cr of I420 half of it (linux/
/// videodev2.h on bytesperline).
struct FrameLayout {
  FrameFormat format;
  std::array<std::size_t, 3> offsetBytes{};
  std::array<std::size_t, 3> strideBytes{};
  std::size_t bytes = 0;  ///< of the whole

  /// `strideBytes` of the first plane; 0: packed. Nothing where a row does not fit into its stride.
  static std::optional<FrameLayout> of(const FrameFormat& format, std::size_t strideBytes);

  /// Copies the picture's rows to their places; what is between them stays as it is. Preconditions:
  /// the picture has this format, and `frame` at least `bytes`.
  void pack(const ImageView& picture, std::span<std::uint8_t> frame) const;
};

/// The format that a device accepted.
struct Agreement {
  FrameLayout layout;
  std::size_t frameBytes = 0;  ///< of one write(): at least layout.bytes
};

/// Agrees on the format of pictures with the output side of `fd`: `layout`, or where that is unset
/// the first of YUYV, NV12 and I420 that the device takes; both sides even, rounded up. A device
/// whose format is held (by a reader that has it open, or by keep_format) keeps it, and its size is
/// the answer. Errors: kUnsupported (none of these layouts, odd sides), kBusy (held in another
/// layout), kDeviceLost, kIo; `subject` names the device.
Result<Agreement> negotiate(v4l2::SystemCalls& calls, int fd, const std::string& subject,
                            const OutputRequest& request, std::optional<PixelFormat> layout);

/// Tells the device the rate, which its readers may ask for; it paces nothing.
void announceRate(v4l2::SystemCalls& calls, int fd, Duration framePeriod);

/// The period in seconds: 1/30, 1001/30000, or what is near.
v4l2_fract fractionOf(Duration period);

}  // namespace pleinair::hal::loopback
