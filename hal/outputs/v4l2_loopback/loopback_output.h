#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/output.h"
#include "hal/output_kind.h"
#include "hal/outputs/v4l2_loopback/loopback_devices.h"

namespace pleinair::hal {

/// A V4L2 output device, most often one of the module v4l2loopback, whose other side programs read
/// as a camera. `name`: "loopback", the first one of that module; "loopback:/dev/video50", a node
/// of any driver; "loopback:LABEL", a card by its label. `layout`: kYuyv, kNv12 or kI420; unset:
/// the first of these that the device takes. Opens nothing yet.
///
/// start() answers what the device agreed to, with even sides; where something holds the format,
/// the size too may be another than requested. Errors also: kBusy (another program writes to it, or
/// its format is held in another layout).
///
/// write() never waits for readers: what the device cannot take at once is skipped and counted
/// (skippedPictures()). Errors also: kBusy.
///
/// Errors: kInvalidArgument (no such name or layout).
Result<std::unique_ptr<MemoryOutput>> openLoopback(const std::string& name,
                                                   std::optional<PixelFormat> layout = {},
                                                   const V4l2System& system = {});

/// "loopback" and "loopback:DEVICE"; its option `format` is the layout.
OutputKind loopbackKind();

}  // namespace pleinair::hal
