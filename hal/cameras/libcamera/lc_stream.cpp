#include "hal/cameras/libcamera/lc_stream.h"

#include <algorithm>
#include <array>
#include <utility>

namespace pleinair::hal::libcamera {
namespace {

std::vector<BufferPlane> planesOf(const lc::FrameBuffer& buffer) {
  std::vector<BufferPlane> planes;
  for (const lc::FrameBuffer::Plane& each : buffer.planes()) {
    planes.push_back(
        {.fd = each.fd.get(),
         .offset = each.offset == lc::FrameBuffer::Plane::kInvalidOffset ? 0 : each.offset,
         .length = each.length});
  }
  return planes;
}

std::array<std::size_t, 3> usedBytesOf(const lc::FrameMetadata& metadata) {
  std::array<std::size_t, 3> used{};
  const auto planes = metadata.planes();
  for (std::size_t i = 0; i < std::min<std::size_t>(planes.size(), used.size()); ++i) {
    used.at(i) = planes[i].bytesused;
  }
  return used;
}

}  // namespace

LibcameraStream::LibcameraStream(std::shared_ptr<Manager> manager,
                                 std::shared_ptr<lc::Camera> camera, lc::Stream* stream,
                                 lc::Stream* luma)
    : manager_(std::move(manager)),
      camera_(std::move(camera)),
      stream_(stream),
      luma_(luma),
      allocator_(std::make_unique<lc::FrameBufferAllocator>(camera_)) {
  camera_->requestCompleted.connect(&posts_, &Posts::complete);
  camera_->disconnected.connect(&posts_, &Posts::disconnect);
}

// The order is libcamera's: stop, requests, buffers, and the rest by the members.
LibcameraStream::~LibcameraStream() {
  camera_->stop();
  camera_->requestCompleted.disconnect(&posts_);
  camera_->disconnected.disconnect(&posts_);
  requests_.clear();
  buffers_.clear();
  lumaBuffers_.clear();
  allocator_->free(stream_);
  if (luma_ != nullptr) allocator_->free(luma_);
}

Result<void> LibcameraStream::allocate(lc::Stream* stream,
                                       std::vector<std::shared_ptr<MappedBuffer>>& buffers) {
  if (const int answer = allocator_->allocate(stream); answer < 0) {
    return tl::unexpected(errnoError({}, "cannot allocate buffers", -answer));
  }
  for (const std::unique_ptr<lc::FrameBuffer>& buffer : allocator_->buffers(stream)) {
    auto mapped = MappedBuffer::map(planesOf(*buffer));
    if (!mapped) return tl::unexpected(mapped.error());
    buffers.push_back(*std::move(mapped));
  }
  return {};
}

Result<void> LibcameraStream::addRequest(std::size_t index) {
  std::unique_ptr<lc::Request> request = camera_->createRequest(index);
  const auto add = [&](lc::Stream* stream) {
    return request->addBuffer(stream, allocator_->buffers(stream)[index].get()) >= 0;
  };
  if (!request || !add(stream_) || (luma_ != nullptr && !add(luma_))) {
    return tl::unexpected(Error{.kind = ErrorKind::kIo, .problem = "cannot make a request"});
  }
  requests_.push_back(std::move(request));
  return {};
}

Result<void> LibcameraStream::begin(const lc::ControlList& controls) {
  if (auto done = allocate(stream_, buffers_); !done) return done;
  if (luma_ != nullptr) {
    if (auto done = allocate(luma_, lumaBuffers_); !done) return done;
    const std::size_t both = std::min(buffers_.size(), lumaBuffers_.size());
    buffers_.resize(both);
    lumaBuffers_.resize(both);
  }
  for (std::size_t i = 0; i < buffers_.size(); ++i) {
    if (auto done = addRequest(i); !done) return done;
  }
  if (const int answer = camera_->start(&controls); answer < 0) {
    return tl::unexpected(errnoError({}, "cannot start streaming", -answer));
  }
  for (const auto& request : requests_) {
    if (const int answer = camera_->queueRequest(request.get()); answer < 0) {
      return tl::unexpected(errnoError({}, "refuses to queue its buffers", -answer));
    }
  }
  return {};
}

std::optional<Completed> LibcameraStream::pop(Duration timeout) {
  lc::Request* const request = posts_.take(std::max(timeout, Duration::zero()));
  if (request == nullptr) return std::nullopt;
  Completed completed{.index = static_cast<std::size_t>(request->cookie())};
  const lc::FrameBuffer* const buffer = request->findBuffer(stream_);
  completed.isCancelled = request->status() == lc::Request::RequestCancelled;
  if (buffer == nullptr || completed.isCancelled) return completed;
  const lc::FrameMetadata& metadata = buffer->metadata();
  completed.isFaulty = metadata.status != lc::FrameMetadata::FrameSuccess;
  completed.sequence = metadata.sequence;
  completed.timestamp = Duration(static_cast<std::int64_t>(metadata.timestamp));
  if (const auto time = request->metadata().get(lc::controls::SensorTimestamp)) {
    completed.sensorTime = Duration(*time);
  }
  completed.usedBytes = usedBytesOf(metadata);
  if (const lc::FrameBuffer* const luma = luma_ ? request->findBuffer(luma_) : nullptr) {
    const bool isFilled = luma->metadata().status == lc::FrameMetadata::FrameSuccess;
    if (isFilled) completed.lumaUsedBytes = usedBytesOf(luma->metadata());
  }
  return completed;
}

int LibcameraStream::push(std::size_t index) {
  requests_[index]->reuse(lc::Request::ReuseBuffers);
  return camera_->queueRequest(requests_[index].get());
}

}  // namespace pleinair::hal::libcamera
