// Discovery, by Aravis (0.8). This file and arv_*.cpp are the only ones that call it.

#include <algorithm>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/cameras/aravis/arv_device.h"
#include "hal/cameras/aravis/arv_handles.h"
#include "hal/cameras/aravis/library.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::aravis {
namespace {

void enableInterface(const char* name, bool isOn) {
  isOn ? arv_enable_interface(name) : arv_disable_interface(name);
}

/// Whether this process may have IPv4 sockets, which the sandbox of a service can forbid. Aravis
/// 0.8.26 crashes without them where it looks for GigE cameras.
bool mayUseIpv4() {
  const FileDescriptor probe(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  return static_cast<bool>(probe);
}

class ArvLibrary final : public Library {
 public:
  Result<std::vector<FoundDevice>> discover(bool gige, bool usb3) override {
    const std::scoped_lock lock(mutex_);  // the list is Aravis' own, for all threads
    enableInterface("GigEVision", gige && mayUseIpv4());
    enableInterface("USB3Vision", usb3);
    arv_update_device_list();
    std::vector<FoundDevice> devices;
    for (unsigned int i = 0; i < arv_get_n_devices(); ++i) {
      const std::string protocol = textOf(arv_get_device_protocol(i));
      if (protocol != "GigEVision" && protocol != "USB3Vision") continue;
      const bool isGige = protocol == "GigEVision";
      devices.push_back({.id = textOf(arv_get_device_id(i)),
                         .physicalId = textOf(arv_get_device_physical_id(i)),
                         .address = isGige ? textOf(arv_get_device_address(i)) : std::string(),
                         .vendor = textOf(arv_get_device_vendor(i)),
                         .model = textOf(arv_get_device_model(i)),
                         .serial = textOf(arv_get_device_serial_nbr(i)),
                         .transport = isGige ? Transport::kGige : Transport::kUsb3});
    }
    return devices;
  }

  Result<std::unique_ptr<Device>> open(const std::string& name) override {
    {
      const std::scoped_lock lock(mutex_);
      if (!mayUseIpv4()) enableInterface("GigEVision", false);
    }
    GlibError error;
    Object<ArvCamera> camera(arv_camera_new(name.c_str(), error.out()));
    if (camera) return arvDevice(std::move(camera));
    Error failure = error.as("cannot be opened");
    if (failure.kind == ErrorKind::kNotFound) {
      failure.problem = "is not there";
      failure.remedy = "`pleinair devices` lists those that are; check its cable and its power";
    }
    return tl::unexpected(std::move(failure));
  }

  std::size_t grantedSocketBuffer(std::size_t bytes) override {
    const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (!socket) return 0;
    const int wanted = static_cast<int>(
        std::min<std::size_t>(bytes, static_cast<std::size_t>(std::numeric_limits<int>::max())));
    setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
    int granted = 0;
    socklen_t length = sizeof granted;
    if (getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &granted, &length) != 0) return 0;
    return static_cast<std::size_t>(std::max(granted, 0)) / 2;  // socket(7): it tells twice as much
  }

  bool mayUsePacketSocket() override {
    return static_cast<bool>(FileDescriptor(::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0)));
  }

 private:
  std::mutex mutex_;
};

}  // namespace

Library& systemLibrary() {
  // Never destroyed: a driver thread that hangs in Aravis may outlive main().
  static ArvLibrary& library = *new ArvLibrary;
  return library;
}

}  // namespace pleinair::hal::aravis
