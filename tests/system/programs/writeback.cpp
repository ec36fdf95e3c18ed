// Writes what a display shows into a picture, through the card's writeback connector (vkms has
// one), while another program is the card's master: by that program's own descriptor, which root
// may copy.
//
// usage: writeback PID CARD FILE      "/dev/dri/card0"; FILE as PPM, of the first CRTC's size
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include <drm_fourcc.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

namespace {

std::system_error failure(const std::string& what, int error = errno) {
  return {error, std::generic_category(), what};
}

/// A copy of the descriptor by which a process has a file open.
int descriptorOf(int pid, const std::string& path) {
  const std::filesystem::path folder = "/proc/" + std::to_string(pid) + "/fd";
  for (const auto& each : std::filesystem::directory_iterator(folder)) {
    std::error_code ignored;
    if (std::filesystem::read_symlink(each.path(), ignored) != path) continue;
    const int process = static_cast<int>(::syscall(SYS_pidfd_open, pid, 0));
    const int number = std::stoi(each.path().filename().string());
    const int copy = static_cast<int>(::syscall(SYS_pidfd_getfd, process, number, 0));
    if (copy < 0) throw failure("pidfd_getfd");
    return copy;
  }
  throw std::runtime_error("process " + std::to_string(pid) + " does not have " + path + " open");
}

class Writeback {
 public:
  explicit Writeback(int card) : card_(card) {
    if (drmSetClientCap(card_, DRM_CLIENT_CAP_WRITEBACK_CONNECTORS, 1) != 0) {
      throw failure("no writeback connectors");
    }
    const drmModeRes* resources = drmModeGetResources(card_);
    if (resources == nullptr || resources->count_crtcs == 0) throw failure("no resources");
    crtc_ = resources->crtcs[0];
    for (int i = 0; i < resources->count_connectors; ++i) {
      const drmModeConnector* each = drmModeGetConnectorCurrent(card_, resources->connectors[i]);
      if (each != nullptr && each->connector_type == DRM_MODE_CONNECTOR_WRITEBACK) {
        connector_ = each->connector_id;
      }
    }
    if (connector_ == 0) throw std::runtime_error("the card has no writeback connector");
    const drmModeCrtc* crtc = drmModeGetCrtc(card_, crtc_);
    if (crtc == nullptr || crtc->mode_valid == 0) throw std::runtime_error("the CRTC is off");
    width_ = crtc->mode.hdisplay;
    height_ = crtc->mode.vdisplay;
    makeBuffer();
  }

  void take() {
    int fence = -1;
    commit({{"CRTC_ID", crtc_},
            {"WRITEBACK_FB_ID", framebuffer_},
            {"WRITEBACK_OUT_FENCE_PTR", reinterpret_cast<std::uintptr_t>(&fence)}});
    constexpr int kPatienceMs = 10'000;
    pollfd done{.fd = fence, .events = POLLIN, .revents = 0};
    const bool isDone = ::poll(&done, 1, kPatienceMs) == 1;
    commit({{"CRTC_ID", 0}});
    if (!isDone) throw std::runtime_error("the card did not write the picture back");
  }

  void save(const std::string& path) const {
    std::ofstream file(path, std::ios::binary);
    file << "P6\n" << width_ << " " << height_ << "\n255\n";
    for (std::uint32_t y = 0; y < height_; ++y) {
      for (std::uint32_t x = 0; x < width_; ++x) {
        const std::uint8_t* pixel = memory_ + y * stride_ + 4 * static_cast<std::size_t>(x);
        const std::array<char, 3> rgb{static_cast<char>(pixel[2]), static_cast<char>(pixel[1]),
                                      static_cast<char>(pixel[0])};
        file.write(rgb.data(), rgb.size());
      }
    }
    if (!file.flush()) throw failure(path);
  }

 private:
  struct Value {
    const char* property;
    std::uint64_t value;
  };

  /// Its owner flips meanwhile, so that the card may be busy.
  void commit(const std::vector<Value>& values) const {
    constexpr int kMostTries = 1000;
    for (int i = 0; i < kMostTries; ++i) {
      drmModeAtomicReq* request = drmModeAtomicAlloc();
      for (const Value& each : values) {
        drmModeAtomicAddProperty(request, connector_, propertyId(each.property), each.value);
      }
      const int failed =
          drmModeAtomicCommit(card_, request, DRM_MODE_ATOMIC_ALLOW_MODESET, nullptr);
      drmModeAtomicFree(request);
      if (failed == 0) return;
      if (failed != -EBUSY) throw failure("cannot commit", -failed);
      ::usleep(1000);
    }
    throw std::runtime_error("the card is always busy");
  }

  std::uint32_t propertyId(const std::string& name) const {
    const drmModeObjectProperties* all =
        drmModeObjectGetProperties(card_, connector_, DRM_MODE_OBJECT_CONNECTOR);
    for (std::uint32_t i = 0; all != nullptr && i < all->count_props; ++i) {
      const drmModePropertyRes* each = drmModeGetProperty(card_, all->props[i]);
      if (each != nullptr && name == static_cast<const char*>(each->name)) return each->prop_id;
    }
    throw std::runtime_error("the writeback connector has no property " + name);
  }

  void makeBuffer() {
    drm_mode_create_dumb made{};
    made.width = width_;
    made.height = height_;
    made.bpp = 32;
    if (drmIoctl(card_, DRM_IOCTL_MODE_CREATE_DUMB, &made) != 0) throw failure("no buffer");
    stride_ = made.pitch;
    const std::array<std::uint32_t, 4> handles{made.handle};
    const std::array<std::uint32_t, 4> strides{made.pitch};
    const std::array<std::uint32_t, 4> offsets{};
    if (drmModeAddFB2(card_, width_, height_, DRM_FORMAT_XRGB8888, handles.data(), strides.data(),
                      offsets.data(), &framebuffer_, 0) != 0) {
      throw failure("no framebuffer");
    }
    drm_mode_map_dumb map{};
    map.handle = made.handle;
    if (drmIoctl(card_, DRM_IOCTL_MODE_MAP_DUMB, &map) != 0) throw failure("cannot map");
    void* memory = ::mmap(nullptr, made.size, PROT_READ | PROT_WRITE, MAP_SHARED, card_,
                          static_cast<off_t>(map.offset));
    if (memory == MAP_FAILED) throw failure("cannot map");
    memory_ = static_cast<std::uint8_t*>(memory);
    std::memset(memory_, 0x55, made.size);  // not a colour of the pictures
  }

  int card_;
  std::uint32_t crtc_ = 0;
  std::uint32_t connector_ = 0;
  std::uint32_t width_ = 0;
  std::uint32_t height_ = 0;
  std::uint32_t framebuffer_ = 0;
  std::size_t stride_ = 0;
  std::uint8_t* memory_ = nullptr;
};

}  // namespace

int main(int count, char** values) {
  const std::span arguments(values, static_cast<std::size_t>(count));
  if (arguments.size() != 4) return 2;
  try {
    Writeback writeback(descriptorOf(std::stoi(arguments[1]), arguments[2]));
    writeback.take();
    writeback.save(arguments[3]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "writeback: %s\n", error.what());
    return 1;
  }
}
