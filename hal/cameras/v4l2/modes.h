#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/camera_backend.h"
#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/layout.h"

namespace pleinair::hal::v4l2 {

/// Sizes that a device offers in one pixel format: a single size, or a range with steps.
struct SizeRange {
  FrameSize smallest;
  FrameSize largest;
  FrameSize step{1, 1};
  FrameSize nearestTo(FrameSize wanted) const;
};

struct DeviceFormat {
  std::uint32_t fourcc = 0;
  std::vector<SizeRange> sizes;  ///< empty where the driver does not say
};

/// The formats that the device lists, in its own order.
std::vector<DeviceFormat> enumerateFormats(const Device& device);

/// The frame periods at one size, shortest first; for a range, both ends. Empty if the driver does
/// not say.
std::vector<Duration> enumeratePeriods(const Device& device, std::uint32_t fourcc, FrameSize size);

/// The device's modes for the listing of cameras.
std::vector<CameraMode> modesOf(const Device& device);

/// The mode to request from the device.
struct ModeChoice {
  const Layout* layout = nullptr;
  std::optional<FrameSize> size;  ///< unset: the device's current size
  std::optional<Duration> period;
  std::vector<Duration> periods;  ///< that the device lists for it, shortest first
  std::string reason;             ///< what decided between it and the next best, a line
};

/// The mode nearest to the request. The criteria, in this order: the requested pixel format;
/// colour; the requested size (else the device's current size); whether the requested rate (else a
/// fluent one) is reached; no compression; the format that is cheapest to paint. Errors:
/// kUnsupported (no supported format, or the device offers none now).
Result<ModeChoice> chooseMode(const Device& device, const StreamRequest& request);

}  // namespace pleinair::hal::v4l2
