// Streams from a host of libcamera whose answers and notes are the input: what the other process
// says is read field by field, and frames lie within the memory that was passed.
#include <array>
#include <chrono>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/cameras/libcamera/frame_layout.h"
#include "hal/cameras/libcamera/host_channel.h"
#include "hal/cameras/libcamera/host_message.h"
#include "hal/cameras/libcamera/hosted_library.h"
#include "hal/cameras/libcamera/libcamera_camera.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;
using namespace pleinair::hal::libcamera;
using namespace std::chrono_literals;

constexpr std::size_t kMemory = 64 * 1024;

/// A host that answers every call at once with messages that were sent before they were asked
/// for: nothing waits.
class ScriptedHost {
 public:
  explicit ScriptedHost(fuzz::Bytes& input) : memory_(memfd_create("frames", MFD_CLOEXEC)) {
    if (ftruncate(memory_.get(), kMemory) != 0) std::abort();
    auto calls = hal::libcamera::HostChannel::pair();
    auto frames = hal::libcamera::HostChannel::pair();
    if (!calls || !frames) std::abort();
    const int answersEnd = (*calls)[1].get();
    const int notesEnd = (*frames)[1].get();
    const HostChannel& answers = channels_[0] = HostChannel(std::move((*calls)[1]));
    const HostChannel& notes = channels_[1] = HostChannel(std::move((*frames)[1]));
    for (const Call call : {Call::kOpen, Call::kDescription, Call::kFormats, Call::kConfigure,
                            Call::kConfigure, Call::kPeriods, Call::kStart}) {
      send(answers, answerTo(call, input), call == Call::kStart);
    }
    for (int i = 0; i < 16; ++i) send(notes, note(input), false);
    // It goes on to take calls, and says no more.
    shutdown(answersEnd, SHUT_WR);
    shutdown(notesEnd, SHUT_WR);
    started_ = StartedHost{.calls = std::move((*calls)[0]), .frames = std::move((*frames)[0])};
  }
  hal::Result<StartedHost> take() { return std::move(started_); }

 private:
  void send(const HostChannel& to, const std::vector<std::uint8_t>& bytes, bool withMemory) const {
    if (bytes.empty()) return;  // as the end of the channel
    const int fd = memory_.get();
    to.send(bytes, withMemory ? std::span<const int>(&fd, 1) : std::span<const int>());
  }

  /// The message, with some of its bytes changed, or cut short.
  static std::vector<std::uint8_t> spoilt(const MessageWriter& message, fuzz::Bytes& input) {
    std::vector<std::uint8_t> bytes(message.bytes().begin(), message.bytes().end());
    while (!bytes.empty() && input.once(6)) {
      bytes[input.number<std::uint16_t>() % bytes.size()] = input.number<std::uint8_t>();
    }
    if (input.once(16)) bytes.resize(input.number<std::uint16_t>() % (bytes.size() + 1));
    return bytes;
  }

  /// Mostly with a second image of half the size.
  static StreamAnswer answerWith(std::uint32_t fourcc, hal::FrameSize size, fuzz::Bytes& input) {
    const auto stride = [&] {
      return input.once(4) ? input.number<std::uint64_t>() : std::size_t{1024};
    };
    StreamAnswer answer{.fourcc = fourcc, .size = size, .strideBytes = stride()};
    if (input.once(4)) return answer;
    answer.luma = StreamImage{
        .fourcc = input.once(4) ? input.number<std::uint32_t>() : lumaFourccs()[input.upTo(3)],
        .size = {size.width / 2, size.height / 2},
        .strideBytes = stride()};
    if (input.once(8)) answer.luma->size.height = input.number<std::int32_t>();
    return answer;
  }

  static SharedBuffers buffers(std::size_t count, fuzz::Bytes& input) {
    SharedBuffers buffers(count);
    for (auto& planes : buffers) {
      for (std::size_t i = 1 + input.upTo(4); i > 0; --i) {
        planes.push_back({.descriptor = input.once(8) ? input.number<std::uint32_t>() : 0,
                          .offset = input.once(4) ? input.number<std::uint64_t>()
                                                  : input.number<std::uint16_t>() % kMemory,
                          .length = input.once(4) ? input.number<std::uint64_t>() : kMemory});
      }
    }
    return buffers;
  }

  static std::vector<std::uint8_t> answerTo(Call call, fuzz::Bytes& input) {
    MessageWriter message;
    message.put(call);
    message.put(!input.once(16));
    const auto side = [&] { return 2 * static_cast<int>(1 + input.upTo(64)); };
    const hal::FrameSize size{side(), side()};
    const std::uint32_t fourcc = frameLayouts()[input.upTo(frameLayouts().size())].fourcc;
    switch (call) {
      case Call::kDescription:
        message.put(std::string("sensor"));
        break;
      case Call::kFormats:
        message.put(std::vector<OfferedFormat>{{.fourcc = fourcc, .sizes = {size}}});
        break;
      case Call::kConfigure:
        message.put(answerWith(fourcc, size, input));
        break;
      case Call::kPeriods:
        message.put(std::optional<std::vector<hal::Duration>>(
            std::vector<hal::Duration>{hal::Duration(input.number<std::uint32_t>()), 100ms}));
        break;
      case Call::kStart: {
        const std::size_t count = 1 + input.upTo(8);
        SharedStream stream{.frames = buffers(count, input), .luma = {}};
        if (input.once(2)) stream.luma = buffers(input.once(8) ? input.upTo(8) : count, input);
        message.put(stream);
        break;
      }
      default:
        break;
    }
    return spoilt(message, input);
  }

  static std::vector<std::uint8_t> note(fuzz::Bytes& input) {
    MessageWriter message;
    message.put(input.once(8) ? FrameNote::kLost : FrameNote::kCompleted);
    message.put(std::uint32_t{1});
    message.put(Completed{.index = input.once(8) ? input.number<std::uint64_t>() : input.upTo(8),
                          .isFaulty = input.once(8),
                          .isCancelled = input.once(16),
                          .sequence = input.number<std::uint32_t>(),
                          .timestamp = hal::Duration(input.number<std::int64_t>()),
                          .sensorTime = {}});
    return spoilt(message, input);
  }

  hal::FileDescriptor memory_;
  std::array<HostChannel, 2> channels_;
  StartedHost started_;
};

void touch(const hal::CapturedFrame& frame) {
  fuzz::touch(frame.image.map().view());
  if (frame.luma) fuzz::touch(frame.luma->map().view());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input(data, size);
  ScriptedHost host(input);
  HostedLibrary library([&] { return host.take(); });
  hal::SteppedClock clock(hal::TimePoint(100s));
  LibcameraCamera camera("sensor", {}, library, clock);
  const auto format = camera.start(
      {.size = hal::FrameSize{64, 48}, .framePeriod = hal::Duration(40ms), .lumaSidePx = 8});
  if (!format) {
    fuzz::expectOneLine(format.error().message());
    return 0;
  }
  std::vector<hal::CapturedFrame> held;
  for (int i = 0; i < 16; ++i) {
    hal::NextFrame next = camera.next(clock.now());
    auto* const frame = std::get_if<hal::CapturedFrame>(&next);
    if (frame == nullptr) break;
    touch(*frame);
    held.push_back(std::move(*frame));
    if (held.size() > 3) held.erase(held.begin());
  }
  camera.stop();
  for (const hal::CapturedFrame& each : held) touch(each);
  return 0;
}
