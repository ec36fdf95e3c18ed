// Reads bytes as a recording: probing, demuxing, decoding, the timeline, and the end.
#include <variant>

#include "hal/cameras/recording/recording.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

constexpr int kMaxFrames = 12;

struct Reader {
  hal::TimePoint last{hal::Duration(-1)};
  std::optional<std::uint64_t> sequence;

  /// Each returns whether to go on.
  bool operator()(const hal::CapturedFrame& frame) {
    fuzz::touch(frame.image.map().view());
    if (frame.captureTime <= last) fuzz::fail("time does not rise");
    if (sequence && frame.sequence <= *sequence) fuzz::fail("sequence does not rise");
    last = frame.captureTime;
    sequence = frame.sequence;
    return true;
  }
  bool operator()(const hal::FormatChanged& changed) const {
    if (!hal::isAcceptedSize(changed.format.frame.size)) fuzz::fail("a size beyond the limits");
    return true;
  }
  bool operator()(const hal::EndOfStream& end) const {
    if (end.truncated) fuzz::expectOneLine(end.truncated->message());
    return false;
  }
  bool operator()(const hal::Error& error) const {
    fuzz::expectOneLine(error.message());
    return false;
  }
  bool operator()(const hal::CameraLost&) const { fuzz::fail("a recording was unplugged"); }
  bool operator()(const hal::CameraTimeout&) const { fuzz::fail("a time-out without a deadline"); }
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::MemoryFile file(data, size);
  hal::SteppedClock clock;
  const auto camera = hal::openRecording(file.path(), clock, {});
  const hal::Result<hal::StreamFormat> format = camera->start({});
  if (!format) {
    fuzz::expectOneLine(format.error().message());
    return 0;
  }
  Reader reader;
  for (int i = 0; i < kMaxFrames; ++i) {
    const hal::NextFrame next = camera->next(hal::kNoDeadline);
    if (!std::visit(reader, next)) break;
  }
  return 0;
}
