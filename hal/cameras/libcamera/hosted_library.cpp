#include "hal/cameras/libcamera/hosted_library.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "hal/cameras/libcamera/host_channel.h"
#include "hal/cameras/libcamera/host_message.h"
#include "hal/cameras/libcamera/library_host.h"
#include "hal/cameras/libcamera/mapped_buffer.h"

namespace pleinair::hal::libcamera {
namespace {

using namespace std::chrono_literals;

/// A listing holds up nobody but those who look for a camera; a first start reads much from disks.
constexpr Duration kListLimit = 20s;
/// Below the limit of driver threads (hal/supervisor/worker_camera.h), as is the next.
constexpr Duration kCallLimit = 8s;
constexpr Duration kStopLimit = 500ms;
class HostedStream final : public Stream {
 public:
  using Buffers = std::vector<std::shared_ptr<MappedBuffer>>;

  /// `luma`: one for each of `buffers`, or none.
  HostedStream(std::shared_ptr<Host> host, std::uint32_t number, Buffers buffers, Buffers luma)
      : host_(std::move(host)),
        number_(number),
        buffers_(std::move(buffers)),
        luma_(std::move(luma)) {}
  ~HostedStream() override {
    // A stream that is lost is not stopped: libcamera 0.0.3 ends its process over it.
    if (isLost_) {
      host_->giveUp();
    } else {
      static_cast<void>(host_->call<void>(Call::kStop, kStopLimit));
    }
  }

  std::size_t bufferCount() const override { return buffers_.size(); }
  std::shared_ptr<const BufferMemory> memory(std::size_t index) const override {
    return {buffers_[index], &buffers_[index]->memory};
  }
  std::shared_ptr<const BufferMemory> lumaMemory(std::size_t index) const override {
    if (luma_.empty()) return nullptr;
    return {luma_[index], &luma_[index]->memory};
  }

  std::optional<Completed> pop(Duration timeout) override {
    if (isLost_) return std::nullopt;
    HostMessage message;
    switch (host_->frames().receive(message, std::max(timeout, Duration::zero()))) {
      case HostChannel::Reception::kMessage:
        return take(message);
      case HostChannel::Reception::kClosed:
        isLost_ = true;
        lossText_ = host_->lossText();
        return std::nullopt;
      case HostChannel::Reception::kTimeout:
        break;
    }
    return std::nullopt;
  }

  int push(std::size_t index) override {
    if (pushFailure_ < 0) return pushFailure_;
    MessageWriter message;
    message.put(FrameNote::kPush);
    message.put(number_);
    message.put(static_cast<std::uint64_t>(index));
    // Where the host has ended, pop() tells.
    host_->frames().send(message.bytes());
    return 0;
  }
  bool isLost() const override { return isLost_; }
  std::string lossText() const override {
    return lossText_.empty() ? Stream::lossText() : lossText_;
  }

 private:
  std::optional<Completed> take(const HostMessage& message) {
    MessageReader reader(message.bytes);
    FrameNote note{};
    std::uint32_t number = 0;
    reader.take(note, kLastNote);
    reader.take(number);
    if (!reader.isValid() || number != number_) return std::nullopt;
    Completed completed;
    int failure = 0;
    switch (note) {
      case FrameNote::kCompleted:
        reader.take(completed);
        if (!reader.isValid() || completed.index >= buffers_.size()) return std::nullopt;
        return completed;
      case FrameNote::kPushFailed:
        reader.take(failure);
        pushFailure_ = std::min(failure, -1);
        break;
      case FrameNote::kLost:
        isLost_ = true;
        break;
      case FrameNote::kPush:
        break;
    }
    return std::nullopt;
  }

  std::shared_ptr<Host> host_;
  std::uint32_t number_;
  Buffers buffers_, luma_;
  int pushFailure_ = 0;
  bool isLost_ = false;
  std::string lossText_;
};

class HostedDevice final : public Device {
 public:
  explicit HostedDevice(std::shared_ptr<Host> host) : host_(std::move(host)) {}

  std::string description() const override { return ask<std::string>(Call::kDescription); }
  std::vector<OfferedFormat> formats() override {
    return ask<std::vector<OfferedFormat>>(Call::kFormats);
  }
  Result<StreamAnswer> configure(const StreamWish& wish) override {
    return host_->call<StreamAnswer>(Call::kConfigure, kCallLimit, wish);
  }
  std::optional<ControlRange> range(Control control) override {
    return ask<std::optional<ControlRange>>(Call::kRange, control);
  }
  bool hasAutomatic(Control control) override { return ask<bool>(Call::kHasAutomatic, control); }
  std::optional<std::array<Duration, 2>> periods() override {
    const auto ends = ask<std::optional<std::vector<Duration>>>(Call::kPeriods);
    if (!ends || ends->size() != 2) return std::nullopt;
    return std::array{(*ends)[0], (*ends)[1]};
  }

  Result<std::unique_ptr<Stream>> start(const StartSettings& settings) override {
    const std::uint32_t number = ++streams_;
    const auto shared = host_->call<SharedStream>(Call::kStart, kCallLimit, settings, number);
    if (!shared) return tl::unexpected(shared.error());
    auto buffers = map(shared->frames);
    if (!buffers) return tl::unexpected(buffers.error());
    auto luma = map(shared->luma);
    if (!luma) return tl::unexpected(luma.error());
    host_->descriptors().clear();
    if (buffers->empty() || (!luma->empty() && luma->size() != buffers->size())) {
      return tl::unexpected(Error{.kind = ErrorKind::kIo, .problem = "has no buffers"});
    }
    return std::make_unique<HostedStream>(host_, number, *std::move(buffers), *std::move(luma));
  }

 private:
  Result<HostedStream::Buffers> map(const SharedBuffers& shared) {
    HostedStream::Buffers buffers;
    for (const std::vector<SharedPlane>& each : shared) {
      auto mapped = map(each);
      if (!mapped) return tl::unexpected(mapped.error());
      buffers.push_back(*std::move(mapped));
    }
    return buffers;
  }

  Result<std::shared_ptr<MappedBuffer>> map(const std::vector<SharedPlane>& planes) {
    const std::vector<FileDescriptor>& descriptors = host_->descriptors();
    std::vector<BufferPlane> own;
    for (const SharedPlane& plane : planes) {
      const int fd =
          plane.descriptor < descriptors.size() ? descriptors[plane.descriptor].get() : -1;
      own.push_back({.fd = fd, .offset = plane.offset, .length = plane.length});
    }
    return MappedBuffer::map(own);
  }

  /// Nothing where the host has ended, which the next call that can fail reports.
  template <class T, class... Arguments>
  T ask(Call what, const Arguments&... arguments) const {
    return host_->call<T>(what, kCallLimit, arguments...).value_or(T{});
  }

  std::shared_ptr<Host> host_;
  std::uint32_t streams_ = 0;
};

}  // namespace

Result<std::shared_ptr<Host>> HostedLibrary::started() {
  Result<StartedHost> started = start_();
  if (!started) return tl::unexpected(std::move(started.error()));
  return std::make_shared<Host>(*std::move(started));
}

std::shared_ptr<Host> HostedLibrary::takeListed() {
  const std::scoped_lock lock(mutex_);
  const std::shared_ptr<ListedHost> listed = std::exchange(listed_, {}).lock();
  return listed ? std::move(listed->host) : nullptr;
}

Result<std::vector<FoundCamera>> HostedLibrary::list() {
  const Result<std::shared_ptr<Host>> host = started();
  if (!host) return tl::unexpected(host.error());
  auto found = (*host)->call<std::vector<FoundCamera>>(Call::kList, kListLimit);
  if (!found) {
    if (found.error().subject.empty()) found.error().subject = "libcamera";
    return found;
  }
  const auto listed = std::make_shared<ListedHost>(ListedHost{*host});
  for (FoundCamera& each : *found) each.kept = listed;
  const std::scoped_lock lock(mutex_);
  listed_ = listed;
  return found;
}

Result<std::unique_ptr<Device>> HostedLibrary::open(const std::string& id) {
  if (std::shared_ptr<Host> host = takeListed()) {
    const Result<void> opened = host->call<void>(Call::kOpen, kCallLimit, id);
    if (opened) return std::make_unique<HostedDevice>(std::move(host));
    // It may have ended, and the devices may be others by now.
    const ErrorKind kind = opened.error().kind;
    if (kind != ErrorKind::kNotFound && kind != ErrorKind::kIo) {
      return tl::unexpected(opened.error());
    }
  }
  Result<std::shared_ptr<Host>> host = started();
  if (!host) return tl::unexpected(std::move(host.error()));
  const Result<void> opened = (*host)->call<void>(Call::kOpen, kCallLimit, id);
  if (!opened) return tl::unexpected(opened.error());
  return std::make_unique<HostedDevice>(*std::move(host));
}

}  // namespace pleinair::hal::libcamera
