#include "tests/support/fake_v4l2.h"

#include <algorithm>
#include <cerrno>
#include <stdexcept>

#include <linux/dma-buf.h>

#include "tests/support/fake_v4l2_device.h"

namespace pleinair::support {

FakeVideo& FakeV4l2::plug(FakeVideo video) {
  const std::scoped_lock lock(mutex_);
  const std::string node = video.node;
  devices_[node] = std::make_shared<Device>(std::move(video), clock_, *this);
  return devices_[node]->video;
}

void FakeV4l2::unplug(const std::string& node, int errnoValue) {
  const std::scoped_lock lock(mutex_);
  devices_.at(node)->lost = errnoValue;
  devices_.erase(node);
}

int FakeV4l2::descriptors() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<int>(files_.size());
}

int FakeV4l2::dmaBufs() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<int>(dmaBufs_.size());
}

int FakeV4l2::mappings() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<int>(mapped_.size());
}

int FakeV4l2::buffers() const {
  const std::scoped_lock lock(mutex_);
  return static_cast<int>(
      std::ranges::count_if(made_, [](const auto& memory) { return !memory.expired(); }));
}

int FakeV4l2::readsBegun() const {
  const std::scoped_lock lock(mutex_);
  return readsBegun_;
}

int FakeV4l2::readsGoingOn() const {
  const std::scoped_lock lock(mutex_);
  return readsBegun_ - readsEnded_;
}

class FakeV4l2::Allocator final : public hal::FrameAllocator {
 public:
  Allocator(FakeV4l2& kernel, int most) : kernel_(kernel), left_(most) {}
  std::string name() const override { return "fake heap"; }
  hal::Result<hal::FileDescriptor> allocate(std::size_t bytes) override {
    if (left_-- <= 0) {
      return tl::unexpected(hal::errnoError(name(), "cannot allocate memory for frames", ENOMEM));
    }
    return hal::FileDescriptor(kernel_.share(bytes), kernel_);
  }

 private:
  FakeV4l2& kernel_;
  int left_;
};

std::shared_ptr<hal::FrameAllocator> FakeV4l2::allocator(int most) {
  return std::make_shared<Allocator>(*this, most);
}

int FakeV4l2::share(std::size_t bytes) {
  const std::scoped_lock lock(mutex_);
  dmaBufs_[nextFd_] = std::make_shared<Memory>(bytes);
  made_.push_back(dmaBufs_[nextFd_]);
  return nextFd_++;
}

int FakeV4l2::sync(const void* argument) {
  const auto flags = static_cast<const dma_buf_sync*>(argument)->flags;
  if ((flags & DMA_BUF_SYNC_READ) == 0) return -EINVAL;
  ++((flags & DMA_BUF_SYNC_END) != 0 ? readsEnded_ : readsBegun_);
  return 0;
}

int FakeV4l2::opens() const {
  const std::scoped_lock lock(mutex_);
  return opens_;
}

int FakeV4l2::controlValue(const std::string& node, std::uint32_t id) const {
  const std::scoped_lock lock(mutex_);
  const auto& controls = devices_.at(node)->video.controls;
  return std::ranges::find(controls, id, &FakeControl::id)->value;
}

std::shared_ptr<FakeV4l2::Device> FakeV4l2::deviceOf(int fd) const {
  const auto found = files_.find(fd);
  return found == files_.end() ? nullptr : found->second;
}

int FakeV4l2::open(const char* path, int) {
  const std::scoped_lock lock(mutex_);
  const auto found = devices_.find(path);
  if (found == devices_.end()) return -ENOENT;
  if (found->second->video.openFailure) return -*found->second->video.openFailure;
  files_[nextFd_] = found->second;
  ++opens_;
  return nextFd_++;
}

int FakeV4l2::close(int fd) {
  const std::scoped_lock lock(mutex_);
  if (dmaBufs_.erase(fd) > 0) return 0;
  const auto device = deviceOf(fd);
  if (device == nullptr) return -EBADF;
  files_.erase(fd);
  if (device->owner != fd) return 0;
  device->halt();
  // A mapping keeps the open file alive, and the file its queue.
  const bool isMapped =
      std::ranges::any_of(mapped_, [&](const auto& each) { return each.second.device == device; });
  if (!isMapped) device->freeBuffers();
  return 0;
}

int FakeV4l2::ioctl(int fd, unsigned long request, void* argument) {
  const std::scoped_lock lock(mutex_);
  if (dmaBufs_.contains(fd)) return request == DMA_BUF_IOCTL_SYNC ? sync(argument) : -ENOTTY;
  const auto device = deviceOf(fd);
  return device == nullptr ? -EBADF : device->answer(fd, request, argument);
}

int FakeV4l2::map(int fd, std::size_t length, std::int64_t offset, void*& address) {
  const std::scoped_lock lock(mutex_);
  if (const auto shared = dmaBufs_.find(fd); shared != dmaBufs_.end()) {
    if (offset != 0 || length > shared->second->size()) return -EINVAL;
    address = shared->second->data();
    mapped_[address] = {.memory = shared->second, .device = nullptr};
    return 0;
  }
  const auto device = deviceOf(fd);
  if (device == nullptr) return -EBADF;
  const auto cookie = static_cast<std::size_t>(offset >> 12);
  if (cookie / 8 >= device->buffers.size()) return -EINVAL;
  const auto& planes = device->buffers[cookie / 8].planes;
  if (cookie % 8 >= planes.size() || length > planes[cookie % 8]->size()) return -EINVAL;
  if (device->video.failures.contains(0)) return -device->video.failures.at(0);
  address = planes[cookie % 8]->data();
  mapped_[address] = {.memory = planes[cookie % 8], .device = device};
  return 0;
}

int FakeV4l2::unmap(void* address, std::size_t) {
  const std::scoped_lock lock(mutex_);
  const auto found = mapped_.find(address);
  if (found == mapped_.end()) return -EINVAL;
  const auto device = found->second.device;
  mapped_.erase(found);
  if (device == nullptr) return 0;
  const bool isOpen = files_.contains(device->owner);
  const bool isMapped =
      std::ranges::any_of(mapped_, [&](const auto& each) { return each.second.device == device; });
  if (!isOpen && !isMapped) device->freeBuffers();
  return 0;
}

int FakeV4l2::pollOne(pollfd& waitFor, const Device& device) const {
  waitFor.revents = 0;
  if (device.lost) {
    waitFor.revents = POLLERR | POLLHUP;
  } else if (!device.streaming) {
    waitFor.revents = POLLERR;
  } else {
    // A last, empty buffer announces a change of source.
    if (!device.done.empty() || device.sourceChanging) waitFor.revents |= POLLIN;
    if (device.eventPending)
      waitFor.revents = static_cast<short>(waitFor.revents | (waitFor.events & POLLPRI));
  }
  return waitFor.revents != 0 ? 1 : 0;
}

int FakeV4l2::poll(std::span<pollfd> waitFor, std::optional<hal::Duration> timeout) {
  std::unique_lock lock(mutex_);
  const auto device = deviceOf(waitFor[0].fd);
  if (device == nullptr) return -EBADF;
  const hal::TimePoint end = timeout ? clock_.now() + *timeout : hal::kNoDeadline;
  if (device->video.spuriousReadies > 0) {
    --device->video.spuriousReadies;
    waitFor[0].revents = POLLIN;
    return 1;
  }
  for (;;) {
    device->advance();
    if (const int ready = pollOne(waitFor[0], *device); ready > 0) return ready;
    if (clock_.now() >= end) return 0;
    const bool gets = !device->queued.empty();
    const auto frame = gets ? device->nextFrameTime() : std::nullopt;
    if (!frame && end == hal::kNoDeadline) throw std::logic_error("waits for a frame for ever");
    const hal::TimePoint until = frame ? std::min(*frame, end) : end;
    lock.unlock();
    clock_.sleepUntil(until);
    lock.lock();
  }
}

std::int64_t FakeV4l2::write(int, std::span<const std::uint8_t>) {
  return -EINVAL;  // these devices only capture
}

}  // namespace pleinair::support
