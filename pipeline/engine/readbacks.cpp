#include "pipeline/engine/readbacks.h"

namespace pleinair {
namespace {

constexpr int kPicturesInFlight = 3;  // of a reader

}  // namespace

int Readbacks::open(const gpu::ShaderLibrary& library, const hal::FrameFormat& format,
                    const std::vector<hal::FrameSize>& sizes, const gpu::GpuTestHook& testHook) {
  auto reader =
      std::make_unique<Reader>(present::Readback(library, format, kPicturesInFlight, testHook));
  for (const hal::FrameSize& size : sizes) reader->ring.warmUp(size);
  readers_.push_back(std::move(reader));
  return static_cast<int>(readers_.size()) - 1;
}

void Readbacks::submit(const gpu::Texture& picture, hal::FrameSize fullSize,
                       const hal::CapturedFrame& frame) {
  for (const auto& reader : readers_) {
    if (!reader->ring.hasRoom()) {
      ++reader->skipped;
      continue;
    }
    reader->ring.submit(picture, fullSize);
    reader->inFlight.push_back({frame.sequence, frame.captureTime});
  }
}

hal::Result<bool> Readbacks::take(int number, OutputFrame& picture, bool wait) {
  Reader& reader = at(number);
  const auto taken = reader.ring.take(picture.image, wait);
  if (!taken) return tl::unexpected(taken.error());
  if (*taken == present::ReadbackResult::kNoImage) return false;
  picture.sequence = reader.inFlight.front().sequence;
  picture.captureTime = reader.inFlight.front().captureTime;
  reader.inFlight.erase(reader.inFlight.begin());
  return true;
}

}  // namespace pleinair
