// Reads bytes as a picture file: signature, header, decoder, conversion, orientation.
#include <optional>
#include <span>

#include "hal/media/picture_file.h"
#include "hal/media/picture_header.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

using namespace pleinair;

/// Larger images within the limits are valid and slow, and find nothing new.
constexpr std::int64_t kMaxPixels = 1'000'000;

bool isSlow(std::span<const std::uint8_t> bytes) {
  const auto kind = hal::pictureKindOf(bytes);
  if (!kind) return false;
  const std::optional<hal::FrameSize> size = hal::peekPictureSize(*kind, bytes);
  return size && hal::isAcceptedSize(*size) && size->pixels() > kMaxPixels;
}

void read(const hal::Result<hal::Image>& picture) {
  if (picture) {
    fuzz::touch(picture->view());
  } else {
    fuzz::expectOneLine(picture.error().message());
  }
}

}  // namespace

#ifdef PLEINAIR_FUZZ
namespace {

std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = ~0U;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1U ^ (0xEDB88320U & (0U - (crc & 1U)));
  }
  return ~crc;
}

/// Corrects the checksum of every complete chunk of a PNG.
void mendPng(std::span<std::uint8_t> bytes) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kOverhead = 12;  // length, type, checksum
  for (std::size_t at = kSignature; at + kOverhead <= bytes.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8U | bytes[at + i];
    if (length > bytes.size() - at - kOverhead) return;
    const std::uint32_t crc = crc32(bytes.subspan(at + 4, length + 4));
    for (std::size_t i = 0; i < 4; ++i) {
      bytes[at + 8 + length + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    }
    at += kOverhead + length;
  }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed);

/// libFuzzer's own mutation. In three of four cases the checksums are corrected, or no PNG would
/// get past its header.
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t most, unsigned seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, most);
  const std::span<std::uint8_t> bytes(data, mutated);
  const auto kind = pleinair::hal::pictureKindOf(bytes);
  if (kind == pleinair::hal::PictureKind::kPng && seed % 4 != 0) mendPng(bytes);
  return mutated;
}
#endif

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (isSlow({data, size})) return -1;
  const fuzz::MemoryFile file(data, size);
  read(hal::readPicture(file.path()));
  read(hal::readPictureRgb(file.path()));
  return 0;
}
