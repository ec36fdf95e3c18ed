#pragma once

#include <array>
#include <optional>

#include "hal/camera.h"
#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/layout.h"

struct v4l2_fract;

namespace pleinair::hal::v4l2 {

/// What a device and we agreed on, as it was read back.
struct Negotiated {
  const Layout* layout = nullptr;
  StreamFormat stream;
  std::array<PlanePlace, 3> places;  ///< of an uncompressed picture
};

/// Of the format that is set now; nothing where there is none.
std::optional<FrameSize> currentSize(const Device& device);

/// Nothing of 0/n and n/0.
std::optional<Duration> durationOf(const v4l2_fract& period);
/// A fraction that drivers find in their lists: 1/30, 1001/30000; else in units of 100 ns, rounded
/// up, because some drivers take the longest period that is not above.
v4l2_fract fractionOf(Duration period);

/// Sets the mode that comes nearest to the request, and the rate; takes over the timings of a
/// device with a digital input (HDMI). What S_FMT answers is the truth. Errors: kBusy, kUnsupported
/// (nothing we read, fields apart, size beyond the limits), kNotFound (unplugged), kDeviceLost (no
/// signal), kIo.
Result<Negotiated> negotiate(const Device& device, const StreamRequest& request);

}  // namespace pleinair::hal::v4l2
