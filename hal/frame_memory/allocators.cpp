#include "hal/frame_memory/allocators.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <system_error>
#include <utility>

#include <drm.h>
#include <drm_mode.h>
#include <fcntl.h>
#include <linux/dma-heap.h>
#include <linux/udmabuf.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace pleinair::hal {
namespace {

constexpr std::size_t kPage = 4096;

std::size_t wholePages(std::size_t bytes) {
  return (bytes + kPage - 1) / kPage * kPage;
}

/// ioctl(), gone on with after EINTR. 0 or errno.
int ask(const FileDescriptor& file, unsigned long request, void* argument) {
  while (::ioctl(file.get(), request, argument) < 0) {
    if (errno != EINTR && errno != EAGAIN) return errno;
  }
  return 0;
}

Result<FileDescriptor> opened(const std::string& path, std::string remedy) {
  FileDescriptor file(::open(path.c_str(), O_RDWR | O_CLOEXEC));
  if (!file) return tl::unexpected(errnoError(path, "cannot open", errno, std::move(remedy)));
  return file;
}

class HeapAllocator final : public FrameAllocator {
 public:
  HeapAllocator(FileDescriptor heap, std::string name)
      : heap_(std::move(heap)), name_(std::move(name)) {}

  std::string name() const override { return "heap " + name_; }
  Result<FileDescriptor> allocate(std::size_t bytes) override {
    dma_heap_allocation_data request{};
    request.len = wholePages(bytes);
    request.fd_flags = O_RDWR | O_CLOEXEC;
    if (const int error = ask(heap_, DMA_HEAP_IOCTL_ALLOC, &request); error != 0) {
      return tl::unexpected(errnoError(name(), "cannot allocate memory for frames", error));
    }
    return FileDescriptor(static_cast<int>(request.fd));
  }

 private:
  FileDescriptor heap_;
  std::string name_;
};

class UdmabufAllocator final : public FrameAllocator {
 public:
  explicit UdmabufAllocator(FileDescriptor device) : device_(std::move(device)) {}

  std::string name() const override { return "udmabuf"; }
  Result<FileDescriptor> allocate(std::size_t bytes) override {
    const FileDescriptor pages(::memfd_create("frame", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    const std::size_t size = wholePages(bytes);
    if (!pages || ::ftruncate(pages.get(), static_cast<off_t>(size)) != 0 ||
        ::fcntl(pages.get(), F_ADD_SEALS, F_SEAL_SHRINK) != 0) {
      return tl::unexpected(errnoError(name(), "cannot reserve memory for frames", errno));
    }
    udmabuf_create request{.memfd = static_cast<std::uint32_t>(pages.get()),
                           .flags = UDMABUF_FLAGS_CLOEXEC,
                           .offset = 0,
                           .size = size};
    FileDescriptor shared(::ioctl(device_.get(), UDMABUF_CREATE, &request));
    if (!shared) return tl::unexpected(errnoError(name(), "cannot share memory for frames", errno));
    return shared;
  }

 private:
  FileDescriptor device_;
};

/// Dumb buffers of a card, a byte a pixel.
class CardAllocator final : public FrameAllocator {
 public:
  CardAllocator(FileDescriptor card, std::string name)
      : card_(std::move(card)), name_(std::move(name)) {}

  std::string name() const override { return name_; }
  Result<FileDescriptor> allocate(std::size_t bytes) override {
    drm_mode_create_dumb made{};
    made.width = kPage;
    made.height = static_cast<std::uint32_t>(wholePages(bytes) / kPage);
    made.bpp = 8;
    if (const int error = ask(card_, DRM_IOCTL_MODE_CREATE_DUMB, &made); error != 0) {
      return tl::unexpected(errnoError(name_, "cannot allocate memory for frames", error));
    }
    drm_prime_handle shared{};
    shared.handle = made.handle;
    shared.flags = DRM_CLOEXEC | DRM_RDWR;
    const int error = ask(card_, DRM_IOCTL_PRIME_HANDLE_TO_FD, &shared);
    drm_gem_close closed{};
    closed.handle = made.handle;
    ask(card_, DRM_IOCTL_GEM_CLOSE, &closed);  // the dma-buf keeps the memory
    if (error != 0) {
      return tl::unexpected(errnoError(name_, "cannot share memory for frames", error));
    }
    return FileDescriptor(shared.fd);
  }

 private:
  FileDescriptor card_;
  std::string name_;
};

Result<std::shared_ptr<FrameAllocator>> openHeap() {
  Error error{.kind = ErrorKind::kNotFound,
              .subject = "/dev/dma_heap",
              .problem = "the kernel has no dma-buf heap",
              .remedy = "choose another camera.v4l2.memory"};
  // Contiguous memory first: few camera bridges have an IOMMU.
  for (const std::string name : {"linux,cma", "reserved", "system"}) {
    const std::string path = "/dev/dma_heap/" + name;
    if (std::error_code ignored; !std::filesystem::exists(path, ignored)) continue;
    auto heap = opened(path, "add the user to the group that owns it");
    if (heap) return std::make_shared<HeapAllocator>(*std::move(heap), name);
    error = heap.error();
  }
  return tl::unexpected(error);
}

Result<std::shared_ptr<FrameAllocator>> openUdmabuf() {
  auto device = opened("/dev/udmabuf", "sudo modprobe udmabuf, where the kernel has it");
  if (!device) return tl::unexpected(device.error());
  return std::make_shared<UdmabufAllocator>(*std::move(device));
}

/// The name of a card's driver.
std::string driverOf(const FileDescriptor& card) {
  std::array<char, 32> name{};
  drm_version version{};
  version.name = name.data();
  version.name_len = name.size() - 1;
  return ask(card, DRM_IOCTL_VERSION, &version) == 0 ? std::string(name.data()) : std::string();
}

Result<std::shared_ptr<FrameAllocator>> openVgem() {
  Error error{.kind = ErrorKind::kNotFound,
              .subject = "vgem",
              .problem = "its module is not loaded",
              .remedy = "sudo modprobe vgem"};
  constexpr int kMostCards = 16;
  for (int i = 0; i < kMostCards; ++i) {
    auto card = opened("/dev/dri/card" + std::to_string(i), "add the user to the group video");
    if (!card) {
      if (card.error().kind == ErrorKind::kPermissionDenied) error = card.error();
      continue;
    }
    if (driverOf(*card) == "vgem") return std::make_shared<CardAllocator>(*std::move(card), "vgem");
  }
  return tl::unexpected(error);
}

}  // namespace

std::string_view toString(AllocatorKind kind) {
  switch (kind) {
    case AllocatorKind::kHeap:
      return "heap";
    case AllocatorKind::kUdmabuf:
      return "udmabuf";
    case AllocatorKind::kVgem:
      return "vgem";
  }
  return "unknown";
}

std::vector<AllocatorKind> allAllocatorKinds() {
  return {AllocatorKind::kHeap, AllocatorKind::kUdmabuf, AllocatorKind::kVgem};
}

Result<std::shared_ptr<FrameAllocator>> openAllocator(AllocatorKind kind) {
  switch (kind) {
    case AllocatorKind::kHeap:
      return openHeap();
    case AllocatorKind::kUdmabuf:
      return openUdmabuf();
    case AllocatorKind::kVgem:
      return openVgem();
  }
  return tl::unexpected(Error{.kind = ErrorKind::kInternal, .problem = "no such allocator"});
}

}  // namespace pleinair::hal
