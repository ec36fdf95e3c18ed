// Streams from a machine-vision camera whose answers are the input: formats, regions, and what
// Aravis says of each frame (sizes, paddings, bytes, numbers, times of chunk data). Whatever it
// says, frames lie within their memory and errors are lines.
#include <chrono>
#include <cmath>
#include <deque>
#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "hal/cameras/aravis/aravis_kind.h"
#include "tests/fuzz/bytes.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/fake_aravis.h"

namespace {

using namespace pleinair;
using namespace std::chrono_literals;
using hal::aravis::BufferStatus;

constexpr std::uint64_t kFrames = 24;

/// PFNC codes: read ones, and any.
std::uint32_t formatOf(fuzz::Bytes& input) {
  return input.once(8)
             ? input.number<std::uint32_t>()
             : input.oneOf<std::uint32_t>({0x01080001, 0x01080008, 0x01080009, 0x0108000A,
                                           0x0108000B, 0x02180014, 0x02100032, 0x0210001F,
                                           0x010C0047, 0x010C0059, 0x010C0006, 0x010C002B});
}

int small(fuzz::Bytes& input) {
  return input.once(16) ? input.number<std::int32_t>() : input.number<std::uint8_t>();
}

support::FakeGigeFrame frameOf(fuzz::Bytes& input) {
  support::FakeGigeFrame frame;
  frame.skipped = input.once(4) ? input.number<std::uint64_t>() : 0;
  frame.underruns = input.number<std::uint8_t>();
  frame.missingPackets = input.number<std::uint8_t>();
  frame.status = input.once(4)
                     ? input.oneOf({BufferStatus::kMissingPackets, BufferStatus::kSizeMismatch,
                                    BufferStatus::kAborted, BufferStatus::kOther})
                     : BufferStatus::kComplete;
  if (input.once(4)) frame.pixelFormat = formatOf(input);
  if (input.once(4)) frame.size = hal::FrameSize{small(input), small(input)};
  if (input.once(4)) frame.usedBytes = input.number<std::uint64_t>();
  if (input.once(4)) frame.age = hal::Duration(input.number<std::int64_t>());
  if (input.once(4)) frame.chunkTime = hal::Duration(input.number<std::int64_t>());
  return frame;
}

support::FakeGigeCamera cameraOf(fuzz::Bytes& input) {
  support::FakeGigeCamera camera;
  camera.transport = input.once(2) ? hal::aravis::Transport::kUsb3 : hal::aravis::Transport::kGige;
  camera.formats.clear();
  for (std::size_t i = input.upTo(5); i > 0; --i) camera.formats.push_back(formatOf(input));
  camera.bounds = {.width = {small(input), small(input), small(input)},
                   .height = {small(input), small(input), small(input)},
                   .xStep = small(input),
                   .yStep = small(input)};
  camera.padding = input.once(4) ? input.number<std::uint8_t>() : 0;
  camera.chunkBytes = input.once(4) ? input.number<std::uint8_t>() : 0;
  camera.maxRate = input.number<std::uint8_t>();
  camera.firstId = input.number<std::uint64_t>();
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    if (input.once(2)) camera.frames[i] = frameOf(input);
  }
  return camera;
}

/// Whether the fake would have to allocate more than it is worth.
bool isLarge(const support::FakeGigeCamera& camera) {
  constexpr double kMost = 1 << 16;
  const auto& bounds = camera.bounds;
  return std::abs(static_cast<double>(bounds.width.max)) *
                 std::abs(static_cast<double>(bounds.height.max)) >
             kMost ||
         std::abs(static_cast<double>(bounds.width.min)) *
                 std::abs(static_cast<double>(bounds.height.min)) >
             kMost;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::Bytes input(data, size);
  hal::SteppedClock clock(hal::TimePoint(100s));
  support::FakeAravis library(clock);
  const support::FakeGigeCamera fake = cameraOf(input);
  if (isLarge(fake)) return -1;
  library.plug(fake);
  hal::aravis::AravisBackend backend({.buffers = 4}, {}, library);
  hal::StreamRequest request;
  if (input.once(2)) request.size = hal::FrameSize{small(input), small(input)};
  if (const auto modes = backend.offeredModes(fake.id, request)) {
    fuzz::expectOneLine(modes->chosen.reason);
  }
  const std::unique_ptr<hal::Camera> camera = backend.make(fake.id, clock);
  const auto format = camera->start(request);
  if (!format) {
    fuzz::expectOneLine(format.error().message());
    return 0;
  }
  std::deque<hal::CapturedFrame> held;
  std::optional<hal::TimePoint> last;
  for (std::uint64_t i = 0; i < kFrames; ++i) {
    hal::NextFrame next = camera->next(clock.now() + 100ms);
    auto* const frame = std::get_if<hal::CapturedFrame>(&next);
    if (std::holds_alternative<hal::CameraTimeout>(next)) continue;
    if (frame == nullptr) break;
    if (last && frame->captureTime <= *last) fuzz::fail("time does not rise");
    last = frame->captureTime;
    fuzz::touch(frame->image.map().view());
    held.push_back(std::move(*frame));
    if (held.size() > 3) held.pop_front();
  }
  camera->stop();
  for (const hal::CapturedFrame& each : held) fuzz::touch(each.image.map().view());
  return 0;
}
