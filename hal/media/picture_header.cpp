#include "hal/media/picture_header.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string_view>

namespace pleinair::hal {
namespace {

using Bytes = std::span<const std::uint8_t>;

bool startsWith(Bytes bytes, std::string_view signature) {
  return bytes.size() >= signature.size() &&
         std::equal(signature.begin(), signature.end(), bytes.begin(),
                    [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
}

std::uint32_t bigEndian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes.subspan(at, count)) value = value << 8 | byte;
  return value;
}

std::uint32_t littleEndian(Bytes bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | bytes[at + i];
  return value;
}

int toSide(std::uint32_t side) {
  constexpr std::uint32_t kMost = std::numeric_limits<int>::max();
  return static_cast<int>(std::min(side, kMost));
}

FrameSize sizeOf(std::uint32_t width, std::uint32_t height) {
  return {toSide(width), toSide(height)};
}

/// Calls visit(marker, offset of the segment's payload, its bytes) for each marker segment before
/// the first scan's entropy-coded data, until it returns true. Returns the offset at which it
/// stopped.
template <class Visitor>
std::size_t walkJpeg(Bytes bytes, Visitor visit) {
  std::size_t at = 2;
  while (at + 4 <= bytes.size()) {
    if (bytes[at] != 0xFF) return at;
    const std::uint8_t marker = bytes[at + 1];
    if (marker == 0xFF) {  // fill byte
      ++at;
      continue;
    }
    const bool standsAlone = marker == 0x01 || (marker >= 0xD0 && marker <= 0xD8);
    if (standsAlone) {
      at += 2;
      continue;
    }
    const std::size_t length = bigEndian(bytes, at + 2, 2);
    if (length < 2) return at;
    if (visit(marker, at + 4, length - 2)) return at;
    at += 2 + length;
  }
  return at;
}

std::optional<FrameSize> jpegSize(Bytes bytes) {
  std::optional<FrameSize> size;
  walkJpeg(bytes, [&](std::uint8_t marker, std::size_t at, std::size_t length) {
    const bool isFrame =
        marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
    if (isFrame && length >= 5 && at + 5 <= bytes.size()) {
      size = sizeOf(bigEndian(bytes, at + 3, 2), bigEndian(bytes, at + 1, 2));
    }
    return isFrame || marker == 0xDA;
  });
  return size;
}

/// Whether an end-of-image marker follows the start of the first scan. Inside entropy-coded data,
/// 0xFF is stuffed.
bool jpegHasEnd(Bytes bytes) {
  const std::size_t scan =
      walkJpeg(bytes, [](std::uint8_t marker, std::size_t, std::size_t) { return marker == 0xDA; });
  if (scan >= bytes.size()) return false;
  const Bytes rest = bytes.subspan(scan);
  return std::adjacent_find(rest.begin(), rest.end(), [](std::uint8_t a, std::uint8_t b) {
           return a == 0xFF && b == 0xD9;
         }) != rest.end();
}

bool pngHasChunk(Bytes bytes, std::string_view type) {
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kChunkOverhead = 12;  // length, type and checksum
  for (std::size_t at = kSignature; at + kChunkOverhead <= bytes.size();) {
    if (startsWith(bytes.subspan(at + 4), type)) return true;
    at += kChunkOverhead + bigEndian(bytes, at, 4);
  }
  return false;
}

std::optional<FrameSize> webpSize(Bytes bytes) {
  if (bytes.size() < 30) return std::nullopt;
  if (startsWith(bytes.subspan(12), "VP8X")) {
    return sizeOf(littleEndian(bytes, 24, 3) + 1, littleEndian(bytes, 27, 3) + 1);
  }
  if (startsWith(bytes.subspan(12), "VP8L")) {
    const std::uint32_t bits = littleEndian(bytes, 21, 4);
    return sizeOf((bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1);
  }
  if (startsWith(bytes.subspan(12), "VP8 ")) {
    return sizeOf(littleEndian(bytes, 26, 2) & 0x3FFF, littleEndian(bytes, 28, 2) & 0x3FFF);
  }
  return std::nullopt;
}

std::optional<FrameSize> bmpSize(Bytes bytes) {
  if (bytes.size() < 26) return std::nullopt;
  if (littleEndian(bytes, 14, 4) == 12) {  // the OS/2 header
    return sizeOf(littleEndian(bytes, 18, 2), littleEndian(bytes, 20, 2));
  }
  std::uint32_t height = littleEndian(bytes, 22, 4);
  if (height > 0x7FFFFFFF) height = ~height + 1;  // negative: stored top-down
  return sizeOf(littleEndian(bytes, 18, 4), height);
}

std::optional<FrameSize> pnmSize(Bytes bytes) {
  std::size_t at = 2;
  std::uint32_t sides[2] = {0, 0};
  for (std::uint32_t& side : sides) {
    while (at < bytes.size() && (bytes[at] <= ' ' || bytes[at] == '#')) {
      if (bytes[at++] != '#') continue;
      while (at < bytes.size() && bytes[at] != '\n') ++at;
    }
    if (at >= bytes.size() || bytes[at] < '0' || bytes[at] > '9') return std::nullopt;
    for (; at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9'; ++at) {
      side = std::min(side * 10 + bytes[at] - '0', 100'000'000u);
    }
  }
  return sizeOf(sides[0], sides[1]);
}

}  // namespace

namespace {

/// ISO/IEC 23008-12: a file type box whose major brand is one of HEIF's for pictures.
bool isHeif(Bytes bytes) {
  if (bytes.size() < 12 || !startsWith(bytes.subspan(4), "ftyp")) return false;
  constexpr std::array<std::string_view, 7> kBrands{"heic", "heix", "heim", "heis",
                                                    "mif1", "avif", "miaf"};
  return std::ranges::any_of(
      kBrands, [&](std::string_view brand) { return startsWith(bytes.subspan(8), brand); });
}

}  // namespace

std::optional<PictureKind> pictureKindOf(Bytes bytes) {
  if (startsWith(bytes, "\x89PNG\r\n\x1a\n")) return PictureKind::kPng;
  if (startsWith(bytes, "\xFF\xD8\xFF")) return PictureKind::kJpeg;
  if (startsWith(bytes, "BM")) return PictureKind::kBmp;
  if (startsWith(bytes, "II*") || startsWith(bytes, "MM")) return PictureKind::kTiff;
  if (startsWith(bytes, "RIFF") && bytes.size() >= 12 && startsWith(bytes.subspan(8), "WEBP")) {
    return PictureKind::kWebp;
  }
  if (isHeif(bytes)) return PictureKind::kHeif;
  if (bytes.size() > 2 && bytes[0] == 'P' && bytes[1] >= '1' && bytes[1] <= '6' &&
      (bytes[2] <= ' ' || bytes[2] == '#')) {
    return PictureKind::kPnm;
  }
  return std::nullopt;
}

std::optional<FrameSize> peekPictureSize(PictureKind kind, Bytes bytes) {
  switch (kind) {
    case PictureKind::kPng:
      if (bytes.size() < 24 || !startsWith(bytes.subspan(12), "IHDR")) return std::nullopt;
      return sizeOf(bigEndian(bytes, 16, 4), bigEndian(bytes, 20, 4));
    case PictureKind::kJpeg:
      return jpegSize(bytes);
    case PictureKind::kBmp:
      return bmpSize(bytes);
    case PictureKind::kWebp:
      return webpSize(bytes);
    case PictureKind::kPnm:
      return pnmSize(bytes);
    case PictureKind::kTiff:
    case PictureKind::kHeif:
      break;
  }
  return std::nullopt;
}

std::optional<std::string_view> defectOf(PictureKind kind, Bytes bytes) {
  const bool hasEnd = kind == PictureKind::kJpeg  ? jpegHasEnd(bytes)
                      : kind == PictureKind::kPng ? pngHasChunk(bytes, "IEND")
                                                  : true;
  if (!hasEnd) return "is truncated";
  constexpr std::size_t kColorTypeAt = 25;
  constexpr std::uint8_t kPaletteColor = 3;
  const bool needsPalette = kind == PictureKind::kPng && bytes.size() > kColorTypeAt &&
                            bytes[kColorTypeAt] == kPaletteColor;
  if (needsPalette && !pngHasChunk(bytes, "PLTE")) return "has no palette";
  return std::nullopt;
}

}  // namespace pleinair::hal
