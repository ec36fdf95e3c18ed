#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <sys/types.h>

#include "hal/cameras/libcamera/library.h"
#include "hal/error.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::libcamera {

/// A process that serves a library (host_server.h), and the program's ends of the channels to it.
struct StartedHost {
  FileDescriptor calls, frames;
  pid_t process = -1;  ///< a child of this process; −1: served in this one, by a test
};
/// Starts a host. Any thread. Errors: kIo.
using HostStarter = std::function<Result<StartedHost>()>;

class Host;
/// The host of a listing, until a camera takes it over.
struct ListedHost {
  std::shared_ptr<Host> host;
};

/// libcamera in another process, one for each listing and for each open camera, because libcamera
/// ends its process on what it does not expect: the end of a device in mid-stream, or its return
/// (docs/decisions/0053-libcamera-process.md). Buffers are dma-bufs that both processes have.
///
/// The process of a listing lives on while one of the cameras that it has found is held
/// (FoundCamera::kept), and the next open() takes it over, which saves starting a process and
/// looking for devices; where it cannot open the camera, a new one tries. It then ends with the
/// device, so that a camera that does not start is not kept from others.
///
/// A host that ends is an error of the call in progress (kIo), or the loss of the stream. One that
/// does not answer within 8 s (20 s for a listing) is killed: kTimeout. The end of a stream takes
/// 0.7 s at most. Any thread; a device and its stream on one.
class HostedLibrary final : public Library {
 public:
  explicit HostedLibrary(HostStarter start) : start_(std::move(start)) {}

  Result<std::vector<FoundCamera>> list() override;
  Result<std::unique_ptr<Device>> open(const std::string& id) override;

 private:
  Result<std::shared_ptr<Host>> started();
  std::shared_ptr<Host> takeListed();

  HostStarter start_;
  std::mutex mutex_;                  // guards the following, and what it refers to
  std::weak_ptr<ListedHost> listed_;  ///< of the last listing
};

}  // namespace pleinair::hal::libcamera
