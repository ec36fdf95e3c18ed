#include "hal/file_descriptor.h"

#include <cerrno>

#include <unistd.h>

namespace pleinair::hal {
namespace {

class SystemCloser final : public DescriptorCloser {
 public:
  int close(int fd) override {
    // After EINTR the descriptor is gone all the same on Linux.
    return ::close(fd) < 0 && errno != EINTR ? -errno : 0;
  }
};

}  // namespace

DescriptorCloser& systemCloser() {
  static SystemCloser closer;
  return closer;
}

}  // namespace pleinair::hal
