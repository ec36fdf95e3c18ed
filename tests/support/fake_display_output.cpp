#include "tests/support/fake_display_output.h"

#include <algorithm>
#include <cassert>
#include <cstring>
#include <string>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

namespace pleinair::support {
namespace {

constexpr std::size_t kPixelBytes = 4;

hal::Error error(hal::ErrorKind kind, std::string problem) {
  return {.kind = kind, .subject = "fake display", .problem = std::move(problem), .remedy = {}};
}

hal::Error lost() {
  return error(hal::ErrorKind::kDeviceLost, "was unplugged");
}

std::uint64_t brightnessOf(const hal::Surface& surface, const std::uint8_t* memory) {
  const auto columns = static_cast<std::size_t>(surface.format.size.width);
  std::uint64_t sum = 0;
  for (int y = 0; y < surface.format.size.height; ++y) {
    const std::uint8_t* row = memory + static_cast<std::size_t>(y) * surface.planes[0].strideBytes;
    for (std::size_t i = 0; i < columns * kPixelBytes; ++i) {
      if (i % kPixelBytes != 3) sum += row[i];
    }
  }
  return sum;
}

}  // namespace

FakeDisplayOutput::FakeDisplayOutput(FakeDisplay& display, const hal::Clock& clock)
    : display_(display), clock_(clock) {}

FakeDisplayOutput::~FakeDisplayOutput() {
  destroyBuffers();
}

void FakeDisplayOutput::destroyBuffers() {
  for (const Buffer& each : buffers_) {
    assert(!each.isMapped);
    ::munmap(each.memory, each.bytes);
    ::close(each.surface.planes[0].dmaBuf);
  }
  buffers_.clear();
  onScreen_ = nullptr;
}

bool FakeDisplayOutput::makeBuffer(hal::FrameSize size, std::uint32_t id) {
  const std::size_t stride =
      static_cast<std::size_t>(size.width) * kPixelBytes + display_.paddingBytes;
  Buffer buffer{.bytes = stride * static_cast<std::size_t>(size.height)};
  const int file = ::memfd_create("surface", MFD_CLOEXEC);
  if (file < 0) return false;
  void* memory = MAP_FAILED;
  if (::ftruncate(file, static_cast<off_t>(buffer.bytes)) == 0) {
    memory = ::mmap(nullptr, buffer.bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  }
  if (memory == MAP_FAILED) {
    ::close(file);
    return false;
  }
  buffer.memory = static_cast<std::uint8_t*>(memory);
  buffer.surface = {
      .id = hal::SurfaceId{id},
      .format = {.pixelFormat = hal::PixelFormat::kRgba8, .size = size, .encoding = {}},
      .fourcc = display_.fourcc,
      .planes = {{{.dmaBuf = file, .offsetBytes = 0, .strideBytes = stride}}}};
  buffers_.push_back(buffer);
  return true;
}

hal::Result<hal::OutputFormat> FakeDisplayOutput::start(const hal::OutputRequest& request) {
  assert(buffers_.empty());
  if (display_.isLost) return tl::unexpected(error(hal::ErrorKind::kNotFound, "is not there"));
  if (!hal::isAcceptedSize(request.size)) {
    return tl::unexpected(error(hal::ErrorKind::kUnsupported, "cannot take this size"));
  }
  if (auto made = makeBuffers(request.size); !made) return tl::unexpected(made.error());
  ++display_.opened;
  ranTo_ = clock_.now();
  return format();
}

hal::Result<hal::OutputFormat> FakeDisplayOutput::reconfigure(const hal::OutputRequest& request) {
  if (display_.isLost) return tl::unexpected(lost());
  runTo(clock_.now());
  for (; !queue_.empty(); queue_.pop_front()) {
    end(queue_.front(), hal::PresentationEvent::Result::kSkipped, clock_.now());
  }
  if (request.size != buffers_.front().surface.format.size) {
    destroyBuffers();
    if (auto made = makeBuffers(request.size); !made) return tl::unexpected(made.error());
  }
  ++display_.reconfigured;
  return format();
}

hal::Result<void> FakeDisplayOutput::makeBuffers(hal::FrameSize size) {
  for (int i = 0; i < display_.surfaces; ++i) {
    if (!makeBuffer(size, static_cast<std::uint32_t>(i))) {
      return tl::unexpected(error(hal::ErrorKind::kIo, "has no memory"));
    }
  }
  return {};
}

hal::OutputFormat FakeDisplayOutput::format() const {
  hal::Refresh refresh{.period = display_.period, .phase = {}};
  if (display_.tellsPhase) refresh.phase = display_.phase;
  return hal::OutputFormat{.frame = buffers_.front().surface.format, .refresh = refresh};
}

hal::Result<void> FakeDisplayOutput::finish() {
  if (display_.isLost) return tl::unexpected(lost());
  return {};
}

FakeDisplayOutput::Buffer& FakeDisplayOutput::of(const hal::Surface& surface) {
  return buffers_.at(static_cast<std::size_t>(surface.id));
}

hal::Result<std::optional<hal::Surface>> FakeDisplayOutput::acquire() {
  if (display_.isLost) return tl::unexpected(lost());
  runTo(clock_.now());
  const auto free = std::ranges::find(buffers_, State::kFree, &Buffer::state);
  if (free == buffers_.end()) return std::nullopt;
  free->state = State::kLent;
  ++display_.lent;
  return free->surface;
}

hal::Result<hal::SurfaceMapping> FakeDisplayOutput::map(const hal::Surface& surface) {
  if (display_.isLost) return tl::unexpected(lost());
  Buffer& buffer = of(surface);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.isMapped = true;
  return hal::SurfaceMapping(*this, surface.id, {std::span(buffer.memory, buffer.bytes)});
}

void FakeDisplayOutput::unmap(hal::SurfaceId surface) {
  buffers_.at(static_cast<std::size_t>(surface)).isMapped = false;
}

void FakeDisplayOutput::release(const hal::Surface& surface) {
  Buffer& buffer = of(surface);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.state = State::kFree;
  --display_.lent;
}

hal::Result<void> FakeDisplayOutput::submit(const hal::Surface& surface, hal::Fence fence,
                                            hal::TimePoint due) {
  if (display_.isLost) return tl::unexpected(lost());
  runTo(clock_.now());
  Buffer& buffer = of(surface);
  assert(buffer.state == State::kLent && !buffer.isMapped);
  buffer.state = State::kQueued;
  --display_.lent;
  queue_.push_back(
      {.buffer = &buffer, .fence = std::move(fence), .due = due, .submitted = clock_.now()});
  return {};
}

hal::TimePoint FakeDisplayOutput::refreshAtOrAfter(hal::TimePoint time) const {
  return hal::refreshAtOrAfter(time, display_.phase, display_.period);
}

/// Whether this refresh, or one before it, is the nearest to the due time, and it may be shown.
bool FakeDisplayOutput::isReady(const Queued& queued, hal::TimePoint refresh) const {
  return queued.submitted <= refresh && queued.due <= refresh + display_.period / 2 &&
         queued.fence.hasSignalled();
}

void FakeDisplayOutput::runTo(hal::TimePoint now) {
  for (hal::TimePoint each = refreshAtOrAfter(ranTo_ + hal::Duration{1}); each <= now;
       each += display_.period) {
    flip(each);
  }
  ranTo_ = std::max(ranTo_, now);
}

void FakeDisplayOutput::end(Queued& queued, hal::PresentationEvent::Result result,
                            hal::TimePoint time) {
  const bool isShown = result == hal::PresentationEvent::Result::kShown;
  const auto sequence =
      static_cast<std::uint64_t>((time - display_.phase) / display_.period) + display_.sequenceJump;
  if (isShown) {
    if (onScreen_ != nullptr) onScreen_->state = State::kFree;
    onScreen_ = queued.buffer;
    std::uint32_t pixel = 0;
    std::memcpy(&pixel, onScreen_->memory, sizeof(pixel));
    display_.shown.push_back({.sequence = sequence,
                              .time = time,
                              .firstPixel = pixel,
                              .brightness = brightnessOf(onScreen_->surface, onScreen_->memory),
                              .size = onScreen_->surface.format.size});
  }
  queued.buffer->state = isShown ? State::kOnScreen : State::kFree;
  events_.push_back({.surface = queued.buffer->surface.id,
                     .result = result,
                     .sequence = isShown ? std::optional(sequence) : std::nullopt,
                     .time = time});
}

/// The newest of the surfaces that are ready, up to the first one that is not, is shown.
void FakeDisplayOutput::flip(hal::TimePoint refresh) {
  using Result = hal::PresentationEvent::Result;
  std::size_t ready = 0;
  while (ready < queue_.size() && isReady(queue_[ready], refresh)) ++ready;
  if (ready == 0) return;
  if (display_.holds > 0) {
    --display_.holds;
    return;
  }
  for (; ready > 1; --ready) {
    end(queue_.front(), Result::kSuperseded, refresh);
    queue_.pop_front();
  }
  const bool isSkipped = display_.skips > 0;
  if (isSkipped) --display_.skips;
  end(queue_.front(), isSkipped ? Result::kSkipped : Result::kShown, refresh);
  queue_.pop_front();
}

hal::Result<void> FakeDisplayOutput::takeEvents(std::vector<hal::PresentationEvent>& events) {
  if (display_.isLost) return tl::unexpected(lost());
  runTo(clock_.now());
  events.insert(events.end(), events_.begin(), events_.end());
  events_.clear();
  return {};
}

std::optional<hal::TimePoint> FakeDisplayOutput::nextEvent() const {
  if (!events_.empty()) return clock_.now();
  if (queue_.empty()) return std::nullopt;
  const hal::TimePoint earliest = queue_.front().due - display_.period / 2;
  return refreshAtOrAfter(std::max(earliest, ranTo_ + hal::Duration{1}));
}

}  // namespace pleinair::support
