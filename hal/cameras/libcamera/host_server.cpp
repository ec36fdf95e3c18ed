#include "hal/cameras/libcamera/host_server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <pthread.h>

#include "hal/cameras/libcamera/host_channel.h"
#include "hal/cameras/libcamera/host_message.h"

namespace pleinair::hal::libcamera {
namespace {

/// The pump may notice the end of a stream so much later.
constexpr Duration kPumpInterval = std::chrono::milliseconds(20);
/// After so long without a frame it is asked whether the device is gone, and again each time.
constexpr Duration kSuspiciousSilence = std::chrono::milliseconds(100);
/// What the library has for the end of its last call once the program has gone.
constexpr Duration kEndingPatience = std::chrono::seconds(1);

/// A stream, and a thread that sends the program what it completes.
class ServedStream {
 public:
  ServedStream(std::unique_ptr<Stream> stream, std::uint32_t number, const HostChannel& frames,
               const std::function<bool()>& isDeviceGone)
      : stream_(std::move(stream)),
        number_(number),
        frames_(frames),
        isDeviceGone_(isDeviceGone),
        pump_([this](const std::stop_token& stop) { pump(stop); }) {}

  std::uint32_t number() const { return number_; }
  const Stream& stream() const { return *stream_; }

  void push(std::uint64_t index) {
    const int answer = index < stream_->bufferCount() ? stream_->push(index) : -EINVAL;
    if (answer < 0) note(FrameNote::kPushFailed, answer);
  }

 private:
  template <class... Values>
  void note(FrameNote what, const Values&... values) const {
    MessageWriter message;
    message.put(what);
    message.put(number_);
    (message.put(values), ...);
    frames_.send(message.bytes());
  }

  void pump(const std::stop_token& stop) {
    pthread_setname_np(pthread_self(), "frames");
    using Steady = std::chrono::steady_clock;
    Steady::time_point heard = Steady::now();
    while (!stop.stop_requested()) {
      if (const std::optional<Completed> completed = stream_->pop(kPumpInterval)) {
        heard = Steady::now();
        note(FrameNote::kCompleted, *completed);
        continue;
      }
      bool isLost = stream_->isLost();
      if (!isLost && Steady::now() - heard >= kSuspiciousSilence) {
        heard = Steady::now();
        isLost = isDeviceGone_ && isDeviceGone_();
      }
      if (!isLost) continue;
      note(FrameNote::kLost);
      return;
    }
  }

  std::unique_ptr<Stream> stream_;
  std::uint32_t number_;
  const HostChannel& frames_;
  const std::function<bool()>& isDeviceGone_;
  std::jthread pump_;  ///< ends first
};

/// The planes of a buffer, whose descriptors are added to those of others, each once.
std::vector<SharedPlane> sharedPlanesOf(const BufferMemory& memory, std::vector<int>& descriptors) {
  std::vector<SharedPlane> planes;
  for (std::size_t plane = 0; plane < static_cast<std::size_t>(memory.planeCount); ++plane) {
    const int fd = memory.dmaBufs.at(plane);
    const auto found = std::ranges::find(descriptors, fd);
    planes.push_back({.descriptor = static_cast<std::uint32_t>(found - descriptors.begin()),
                      .offset = memory.offsets.at(plane),
                      .length = memory.planes.at(plane).size()});
    if (found == descriptors.end()) descriptors.push_back(fd);
  }
  return planes;
}

std::pair<SharedStream, std::vector<int>> sharedStreamOf(const Stream& stream) {
  std::pair<SharedStream, std::vector<int>> shared;
  auto& [buffers, descriptors] = shared;
  for (std::size_t i = 0; i < stream.bufferCount(); ++i) {
    buffers.frames.push_back(sharedPlanesOf(*stream.memory(i), descriptors));
    const std::shared_ptr<const BufferMemory> luma = stream.lumaMemory(i);
    if (luma != nullptr) buffers.luma.push_back(sharedPlanesOf(*luma, descriptors));
  }
  return shared;
}

class HostServer {
 public:
  HostServer(Library& library, FileDescriptor calls, FileDescriptor frames, HostOptions options)
      : library_(library),
        options_(std::move(options)),
        calls_(std::move(calls)),
        frames_(std::move(frames)),
        returns_([this] { takeReturns(); }) {}

  void run() {
    HostMessage message;
    while (calls_.receive(message, std::nullopt) == HostChannel::Reception::kMessage) {
      MessageReader reader(message.bytes);
      Call call{};
      reader.take(call, kLastCall);
      MessageWriter reply;
      descriptors_.clear();
      if (reader.isValid()) {
        reply.put(call);
        answer(call, reader, reply);
      }
      if (!reader.isValid() || !calls_.send(reply.bytes(), descriptors_)) break;
    }
    endStream();
    device_.reset();
    const std::scoped_lock lock(mutex_);
    hasEnded_ = true;
    ended_.notify_all();
  }

 private:
  void answer(Call call, MessageReader& reader, MessageWriter& reply) {
    switch (call) {
      case Call::kList:
        return reply.put(library_.list());
      case Call::kOpen:
        return reply.put(open(reader));
      case Call::kStop:
        endStream();
        return reply.put(Result<void>());
      default:
        if (device_) return answerOf(*device_, call, reader, reply);
        return reply.put(Result<void>(tl::unexpected(
            Error{.kind = ErrorKind::kInvalidArgument, .problem = "no camera is open"})));
    }
  }

  void answerOf(Device& device, Call call, MessageReader& reader, MessageWriter& reply) {
    Control control{};
    switch (call) {
      case Call::kDescription:
        return reply.put(Result<std::string>(device.description()));
      case Call::kFormats:
        return reply.put(Result<std::vector<OfferedFormat>>(device.formats()));
      case Call::kConfigure: {
        StreamWish wish;
        reader.take(wish);
        if (reader.isValid()) reply.put(device.configure(wish));
        return;
      }
      case Call::kRange:
        reader.take(control, kControls.back());
        return reply.put(Result<std::optional<ControlRange>>(device.range(control)));
      case Call::kHasAutomatic:
        reader.take(control, kControls.back());
        return reply.put(Result<bool>(device.hasAutomatic(control)));
      case Call::kPeriods: {
        const auto periods = device.periods();
        std::optional<std::vector<Duration>> ends;
        if (periods) ends.emplace(periods->begin(), periods->end());
        return reply.put(Result<std::optional<std::vector<Duration>>>(ends));
      }
      case Call::kStart:
        return reply.put(start(device, reader));
      default:
        return;
    }
  }

  Result<void> open(MessageReader& reader) {
    std::string id;
    reader.take(id);
    endStream();
    device_.reset();
    Result<std::unique_ptr<Device>> device = library_.open(id);
    if (!device) return tl::unexpected(device.error());
    device_ = *std::move(device);
    return {};
  }

  Result<SharedStream> start(Device& device, MessageReader& reader) {
    StartSettings settings;
    std::uint32_t number = 0;
    reader.take(settings);
    reader.take(number);
    endStream();
    Result<std::unique_ptr<Stream>> stream = device.start(settings);
    if (!stream) return tl::unexpected(stream.error());
    auto [buffers, descriptors] = sharedStreamOf(**stream);
    if (std::ranges::any_of(descriptors, [](int fd) { return fd < 0; })) {
      return tl::unexpected(
          Error{.kind = ErrorKind::kUnsupported, .problem = "has buffers that cannot be shared"});
    }
    descriptors_ = std::move(descriptors);
    const std::scoped_lock lock(mutex_);
    stream_ =
        std::make_unique<ServedStream>(*std::move(stream), number, frames_, options_.isDeviceGone);
    return buffers;
  }

  void endStream() {
    std::unique_ptr<ServedStream> ended;
    {
      const std::scoped_lock lock(mutex_);
      ended = std::move(stream_);
    }
  }

  /// A thread: gives buffers back to the stream, and notices the end of the program.
  void takeReturns() {
    pthread_setname_np(pthread_self(), "returns");
    HostMessage message;
    while (frames_.receive(message, std::nullopt) == HostChannel::Reception::kMessage) {
      MessageReader reader(message.bytes);
      FrameNote note{};
      std::uint32_t number = 0;
      std::uint64_t index = 0;
      reader.take(note, FrameNote::kPush);
      reader.take(number);
      reader.take(index);
      const std::scoped_lock lock(mutex_);
      if (reader.isValid() && stream_ && stream_->number() == number) stream_->push(index);
    }
    std::unique_lock lock(mutex_);
    const bool hasEnded = ended_.wait_for(lock, kEndingPatience, [this] { return hasEnded_; });
    if (!hasEnded && options_.onHanging) options_.onHanging();
  }

  Library& library_;
  HostOptions options_;
  HostChannel calls_, frames_;
  std::unique_ptr<Device> device_;
  std::vector<int> descriptors_;  ///< of the next answer
  std::mutex mutex_;              ///< guards the following
  std::condition_variable ended_;
  bool hasEnded_ = false;
  std::unique_ptr<ServedStream> stream_;
  std::jthread returns_;
};

}  // namespace

void serveLibrary(Library& library, FileDescriptor calls, FileDescriptor frames,
                  HostOptions options) {
  HostServer(library, std::move(calls), std::move(frames), std::move(options)).run();
}

bool holdsRemovedNode(const std::string& folder) {
  constexpr std::array<std::string_view, 3> kNodes{"/dev/video", "/dev/media", "/dev/v4l-subdev"};
  constexpr std::string_view kRemoved = " (deleted)";
  std::error_code error;
  for (std::filesystem::directory_iterator each(folder, error), end; !error && each != end;
       each.increment(error)) {
    std::error_code unread;
    const std::string target = std::filesystem::read_symlink(each->path(), unread).string();
    if (unread || !target.ends_with(kRemoved)) continue;
    if (std::ranges::any_of(kNodes, [&](auto node) { return target.starts_with(node); })) {
      return true;
    }
  }
  return false;
}

}  // namespace pleinair::hal::libcamera
