#include "tests/support/gige_simulator.h"

#include <atomic>
#include <cstring>
#include <fstream>

#include <arv.h>
#include <net/if.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/file_descriptor.h"

namespace pleinair::support {
namespace {

ifreq loopbackRequest() {
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  return request;
}

bool writeText(const char* file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  return static_cast<bool>(stream.flush());
}

}  // namespace

bool enterPrivateNetwork() {
  const unsigned uid = getuid(), gid = getgid();
  if (unshare(CLONE_NEWNET) != 0) {
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
    writeText("/proc/self/setgroups", "deny");
    writeText("/proc/self/uid_map", "0 " + std::to_string(uid) + " 1");
    writeText("/proc/self/gid_map", "0 " + std::to_string(gid) + " 1");
  }
  const hal::FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request = loopbackRequest();
  request.ifr_flags = IFF_UP | IFF_LOOPBACK | IFF_RUNNING;
  return socket && ioctl(socket.get(), SIOCSIFFLAGS, &request) == 0;
}

bool setLoopbackMtu(int bytes) {
  const hal::FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  ifreq request = loopbackRequest();
  request.ifr_mtu = bytes;
  return socket && ioctl(socket.get(), SIOCSIFMTU, &request) == 0;
}

struct GigeSimulator::Impl {
  ArvGvFakeCamera* camera = nullptr;
  std::atomic<std::uint64_t> frames = 0;

  static void fill(ArvBuffer* buffer, void* self, guint32, guint32, ArvPixelFormat format) {
    const std::uint64_t number = static_cast<Impl*>(self)->frames++;
    size_t size = 0;
    auto* data = static_cast<std::uint8_t*>(const_cast<void*>(arv_buffer_get_data(buffer, &size)));
    // `size` is that of the frame before.
    size = static_cast<size_t>(arv_buffer_get_image_width(buffer)) *
           static_cast<size_t>(arv_buffer_get_image_height(buffer)) *
           ARV_PIXEL_FORMAT_BIT_PER_PIXEL(format) / 8;
    for (size_t i = 0; i < size; ++i) data[i] = static_cast<std::uint8_t>(i + number);
  }
};

GigeSimulator::GigeSimulator(const std::string& serial) : impl_(std::make_unique<Impl>()) {
  impl_->camera = arv_gv_fake_camera_new("127.0.0.1", serial.c_str());
  arv_fake_camera_set_fill_pattern(arv_gv_fake_camera_get_fake_camera(impl_->camera), &Impl::fill,
                                   impl_.get());
}

GigeSimulator::~GigeSimulator() {
  g_object_unref(impl_->camera);
}

bool GigeSimulator::isRunning() const {
  return arv_gv_fake_camera_is_running(impl_->camera) != 0;
}

std::uint64_t GigeSimulator::framesMade() const {
  return impl_->frames;
}

}  // namespace pleinair::support
