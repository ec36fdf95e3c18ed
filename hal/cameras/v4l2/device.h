#pragma once

#include <cstdint>
#include <string>

#include "hal/error.h"
#include "hal/file_descriptor.h"
#include "hal/v4l2/capability.h"
#include "hal/v4l2/system_calls.h"

namespace pleinair::hal::v4l2 {

/// An open capture node. One thread at a time; the last owner closes it.
class Device {
 public:
  /// Opens without blocking. Errors: kNotFound, kPermissionDenied, kBusy, kUnsupported (no video
  /// capture or no streaming), kIo.
  static Result<Device> open(SystemCalls& calls, const std::string& node);

  /// Calls ioctl. 0 or more, or −errno.
  template <class Argument>
  int ask(unsigned long request, Argument& argument) const {
    return calls_->ioctl(descriptor_.get(), request, &argument);
  }

  SystemCalls& calls() const { return *calls_; }
  int fd() const { return descriptor_.get(); }
  const std::string& node() const { return node_; }
  const Capability& capability() const { return capability_; }
  /// Whether the device has only the multi-planar interface.
  bool isMultiPlanar() const;
  /// V4L2_BUF_TYPE_VIDEO_CAPTURE or …_MPLANE.
  std::uint32_t bufferType() const;

  /// "/dev/video0: `problem`: the system's text". `answer` is a negative answer of ask().
  Error failure(std::string problem, int answer) const;

 private:
  Device(SystemCalls& calls, std::string node, FileDescriptor descriptor, Capability capability);

  SystemCalls* calls_;
  std::string node_;
  FileDescriptor descriptor_;
  Capability capability_;
};

/// Whether −errno means that the device was unplugged or no longer answers.
bool meansLost(int answer);

}  // namespace pleinair::hal::v4l2
