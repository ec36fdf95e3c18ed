#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <linux/videodev2.h>

#include "hal/error.h"
#include "hal/output.h"
#include "hal/outputs/v4l2_loopback/frame_layout.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::loopback {

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
