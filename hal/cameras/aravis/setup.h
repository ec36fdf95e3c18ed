#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "hal/camera.h"
#include "hal/cameras/aravis/library.h"
#include "hal/cameras/aravis/pixel_layout.h"
#include "hal/clock.h"

namespace pleinair::hal::aravis {

/// What [camera.aravis] sets.
struct AravisOptions {
  std::string pixelFormat = "auto";  ///< or a name of pixelLayouts()
  int offsetX = -1, offsetY = -1;    ///< of the region on the sensor, px; −1: in the middle
  int binning = 1;                   ///< sensor pixels that become one, in both directions
  std::string trigger = "free";      ///< or "software", or a trigger source: "Line1"
  int packetBytes = 0;               ///< 0: negotiated
  bool resends = true;
  Duration frameRetention = std::chrono::milliseconds(100);
  std::size_t socketBufferBytes = 4'194'304;
  bool packetSocket = true;  ///< where the process may use one
  int buffers = 8;
  bool chunkTimestamps = true;
};

/// The format of a device that is set up.
struct Negotiated {
  const PixelLayout* layout = nullptr;
  Region region;
  std::optional<Duration> framePeriod;  ///< unset while a line triggers
  bool isSoftwareTriggered = false;
  bool isLineTriggered = false;
  std::size_t bufferBytes = 0;
  std::optional<int> packetBytes;  ///< GigE only
};

/// The device's bounds, with steps of 1 at least and within them. Errors: kUnsupported if they hold
/// no region; those of Device.
Result<RegionBounds> readBounds(Device& device);

/// The size of the region that is read for a request: the largest that is not larger, even where
/// pixels form a mosaic.
FrameSize regionSizeFor(const RegionBounds& bounds, const PixelLayout& layout,
                        std::optional<FrameSize> asked);

/// Sets the device to what is asked for and reads back what it does: binning, pixel format, region,
/// rate, controls, trigger, packets. Exposure is clamped to the device's range; gain is a share of
/// it. Errors: kUnsupported, with what the device has; kBusy if another program controls it; those
/// of Device.
Result<Negotiated> setUp(Device& device, const AravisOptions& options,
                         const StreamRequest& request);

/// What the user should know before frames are lost: a receive buffer that is smaller than was
/// asked for. Empty if all is well.
std::string linkWarning(Library& library, const Device& device, const AravisOptions& options);

}  // namespace pleinair::hal::aravis
