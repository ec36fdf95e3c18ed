#pragma once

#include <array>
#include <optional>

#include "hal/camera.h"
#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/layout.h"

struct v4l2_fract;

namespace pleinair::hal::v4l2 {

/// The negotiated format, as read back from the device.
struct Negotiated {
  const Layout* layout = nullptr;
  StreamFormat stream;
  std::array<PlanePlace, 3> places;  ///< for uncompressed formats only
  /// The bytes that the driver wants in each memory plane (sizeimage).
  std::array<std::size_t, 3> imageBytes{};
};

/// The size of the current format; nothing if none is set.
std::optional<FrameSize> currentSize(const Device& device);

/// The period of a fraction; nothing for 0/n and n/0.
std::optional<Duration> durationOf(const v4l2_fract& period);
/// The period as a fraction that occurs in drivers' lists, such as 1/30 or 1001/30000; else in
/// units of 100 ns, rounded up, because some drivers take the longest period that is not longer.
v4l2_fract fractionOf(Duration period);

/// Sets the mode nearest to the request and its frame rate; adopts the signal timings of a device
/// with a digital input (HDMI). The format that S_FMT answers is used. Errors: kBusy, kUnsupported
/// (no known format, separate fields, size beyond the limits), kNotFound (unplugged), kDeviceLost
/// (no signal), kIo.
Result<Negotiated> negotiate(const Device& device, const StreamRequest& request);

}  // namespace pleinair::hal::v4l2
