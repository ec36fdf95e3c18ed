#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "hal/cameras/libcamera/lc_manager.h"
#include "hal/cameras/libcamera/lc_version.h"
#include "hal/cameras/libcamera/library.h"
#include "hal/cameras/libcamera/mapped_buffer.h"
#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::hal::libcamera {

/// What libcamera's thread posts, and the camera's thread takes. Signals are connected to it, and
/// not to an object of libcamera's, whose slots would wait for an event loop. Any thread.
class Posts {
 public:
  void complete(lc::Request* request) {
    const std::scoped_lock lock(mutex_);
    requests_.push_back(request);
    changed_.notify_one();
  }
  void disconnect() {
    const std::scoped_lock lock(mutex_);
    isLost_ = true;
    changed_.notify_one();
  }
  lc::Request* take(Duration timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return isLost_ || !requests_.empty(); });
    if (requests_.empty()) return nullptr;
    lc::Request* const request = requests_.front();
    requests_.pop_front();
    return request;
  }
  bool isLost() const {
    const std::scoped_lock lock(mutex_);
    return isLost_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<lc::Request*> requests_;
  bool isLost_ = false;
};

/// The requests of a configured camera, with their buffers. The destructor stops the camera.
class LibcameraStream final : public Stream {
 public:
  /// `luma`: the stream of second images; null: there is none.
  LibcameraStream(std::shared_ptr<Manager> manager, std::shared_ptr<lc::Camera> camera,
                  lc::Stream* stream, lc::Stream* luma);
  ~LibcameraStream() override;

  /// Allocates, starts and queues all; once. Errors: kIo and others of libcamera.
  Result<void> begin(const lc::ControlList& controls);

  std::size_t bufferCount() const override { return requests_.size(); }
  std::shared_ptr<const BufferMemory> memory(std::size_t index) const override {
    return {buffers_[index], &buffers_[index]->memory};
  }
  std::shared_ptr<const BufferMemory> lumaMemory(std::size_t index) const override {
    if (luma_ == nullptr) return nullptr;
    return {lumaBuffers_[index], &lumaBuffers_[index]->memory};
  }
  std::optional<Completed> pop(Duration timeout) override;
  int push(std::size_t index) override;
  bool isLost() const override { return posts_.isLost(); }

 private:
  Result<void> allocate(lc::Stream* stream, std::vector<std::shared_ptr<MappedBuffer>>& buffers);
  Result<void> addRequest(std::size_t index);

  std::shared_ptr<Manager> manager_;
  std::shared_ptr<lc::Camera> camera_;
  lc::Stream* stream_;
  lc::Stream* luma_;
  Posts posts_;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  std::vector<std::shared_ptr<MappedBuffer>> buffers_, lumaBuffers_;
  std::vector<std::unique_ptr<lc::Request>> requests_;
};

}  // namespace pleinair::hal::libcamera
