#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "hal/camera.h"
#include "hal/camera_backend.h"
#include "hal/cameras/v4l2/device.h"
#include "hal/cameras/v4l2/layout.h"

namespace pleinair::hal::v4l2 {

/// Sizes that a device offers in one pixel format: one, or a range in steps.
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

/// What the device says it can capture, in its own order.
std::vector<DeviceFormat> enumerateFormats(const Device& device);

/// Frame periods at one size, shortest first; of a range, both ends. Empty where it does not say.
std::vector<Duration> enumeratePeriods(const Device& device, std::uint32_t fourcc, FrameSize size);

/// The modes as the listing shows them.
std::vector<CameraMode> modesOf(const Device& device);

/// What to ask the device for.
struct ModeChoice {
  const Layout* layout = nullptr;
  std::optional<FrameSize> size;  ///< unset: whatever the device has set
  std::optional<Duration> period;
};

/// The mode that comes nearest to the request, by, in this order: the pixel format asked for;
/// colour; the size asked for (else the device's current one); whether the rate asked for (else a
/// fluent one) is reached; no compression; what costs least to paint. Errors: kUnsupported (none of
/// its formats is read, or it has none now).
Result<ModeChoice> chooseMode(const Device& device, const StreamRequest& request);

}  // namespace pleinair::hal::v4l2
