#include "hal/cameras/libcamera/lc_stream.h"

#include <algorithm>
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

}  // namespace

LibcameraStream::LibcameraStream(std::shared_ptr<Manager> manager,
                                 std::shared_ptr<lc::Camera> camera, lc::Stream* stream)
    : manager_(std::move(manager)),
      camera_(std::move(camera)),
      stream_(stream),
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
  allocator_->free(stream_);
}

Result<void> LibcameraStream::begin(const lc::ControlList& controls) {
  if (const int answer = allocator_->allocate(stream_); answer < 0) {
    return tl::unexpected(errnoError({}, "cannot allocate buffers", -answer));
  }
  for (const std::unique_ptr<lc::FrameBuffer>& buffer : allocator_->buffers(stream_)) {
    auto mapped = MappedBuffer::map(planesOf(*buffer));
    if (!mapped) return tl::unexpected(mapped.error());
    std::unique_ptr<lc::Request> request = camera_->createRequest(requests_.size());
    if (!request || request->addBuffer(stream_, buffer.get()) < 0) {
      return tl::unexpected(Error{.kind = ErrorKind::kIo, .problem = "cannot make a request"});
    }
    buffers_.push_back(*std::move(mapped));
    requests_.push_back(std::move(request));
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
  const auto planes = metadata.planes();
  for (std::size_t i = 0; i < std::min<std::size_t>(planes.size(), 3); ++i) {
    completed.usedBytes.at(i) = planes[i].bytesused;
  }
  return completed;
}

int LibcameraStream::push(std::size_t index) {
  requests_[index]->reuse(lc::Request::ReuseBuffers);
  return camera_->queueRequest(requests_[index].get());
}

}  // namespace pleinair::hal::libcamera
