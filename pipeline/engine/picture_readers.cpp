#include "pipeline/engine/picture_readers.h"

namespace pleinair {
namespace {

constexpr int kPicturesUnderWay = 3;  // of a reader

}  // namespace

int PictureReaders::open(const gpu::ShaderLibrary& library, const hal::FrameFormat& format,
                         const std::vector<hal::FrameSize>& sizes, const gpu::GpuSeam& seam) {
  auto reader =
      std::make_unique<Reader>(present::PictureReader(library, format, kPicturesUnderWay, seam));
  for (const hal::FrameSize& size : sizes) reader->ring.warmUp(size);
  readers_.push_back(std::move(reader));
  return static_cast<int>(readers_.size()) - 1;
}

void PictureReaders::submit(const gpu::Texture& picture, hal::FrameSize fullSize,
                            const hal::CapturedFrame& frame) {
  for (const auto& reader : readers_) {
    if (!reader->ring.hasRoom()) {
      ++reader->skipped;
      continue;
    }
    reader->ring.submit(picture, fullSize);
    reader->underWay.push_back({frame.sequence, frame.captureTime});
  }
}

hal::Result<bool> PictureReaders::take(int number, ReadPicture& picture, bool wait) {
  Reader& reader = at(number);
  const hal::Result<bool> taken = reader.ring.take(picture.image, wait);
  if (!taken || !*taken) return taken;
  picture.sequence = reader.underWay.front().sequence;
  picture.captureTime = reader.underWay.front().captureTime;
  reader.underWay.erase(reader.underWay.begin());
  return true;
}

}  // namespace pleinair
