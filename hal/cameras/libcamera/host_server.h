#pragma once

#include <functional>
#include <string>

#include "hal/cameras/libcamera/library.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::libcamera {

struct HostOptions {
  /// Whether the device of the stream is gone, asked while no frames come; any thread.
  std::function<bool()> isDeviceGone;
  /// Called on a thread of the server's where the program has gone and the library still hangs in
  /// a call a second later.
  std::function<void()> onHanging;
};

/// Carries out what a HostedLibrary asks for, with a library in this process, until the program
/// closes its ends of the two channels. Calls are answered one after the other on this thread. One
/// camera, with one stream at a time.
void serveLibrary(Library& library, FileDescriptor calls, FileDescriptor frames,
                  HostOptions options);

/// Whether one of the open files in `folder` is a node of a camera (/dev/video0, /dev/media0,
/// /dev/v4l-subdev0) that has been removed since, which is how the loss of a device shows that its
/// driver does not report. `folder`: links as those of /proc/self/fd.
bool holdsRemovedNode(const std::string& folder);

}  // namespace pleinair::hal::libcamera
