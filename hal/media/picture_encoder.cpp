#include "hal/media/picture_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string_view>
#include <utility>

#include "hal/media/jpeg_encoder.h"
#include "hal/media/png_encoder.h"
#include "hal/media/tiff_encoder.h"

namespace pleinair::hal {
namespace {

struct PictureEnding {
  std::string_view text;
  PictureFileKind kind;
};
constexpr std::array<PictureEnding, 5> kWrittenEndings{{{".png", PictureFileKind::kPng},
                                                        {".jpg", PictureFileKind::kJpeg},
                                                        {".jpeg", PictureFileKind::kJpeg},
                                                        {".tif", PictureFileKind::kTiff},
                                                        {".tiff", PictureFileKind::kTiff}}};

using Bytes = std::vector<std::uint8_t>;

void appendBig32(Bytes& bytes, std::uint32_t value) {
  for (const unsigned shift : {24U, 16U, 8U, 0U}) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift & 0xFFU));
  }
}

/// CRC-32 as of the PNG specification (ISO/IEC 15948, annex D).
std::uint32_t crcOf(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = 0xFFFFFFFFU;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = (crc & 1U) != 0 ? 0xEDB88320U ^ (crc >> 1U) : crc >> 1U;
    }
  }
  return ~crc;
}

void appendChunk(Bytes& bytes, std::string_view type, const Bytes& data) {
  appendBig32(bytes, static_cast<std::uint32_t>(data.size()));
  const std::size_t begin = bytes.size();
  bytes.insert(bytes.end(), type.begin(), type.end());
  bytes.insert(bytes.end(), data.begin(), data.end());
  appendBig32(bytes, crcOf(std::span(bytes).subspan(begin)));
}

/// The chunks sRGB and pHYs (ISO/IEC 15948 §11.3.2.5, §11.3.4.3), which stand before the image.
class TaggedPng final : public PictureEncoder {
 public:
  TaggedPng(libav::PngEncoder encoder, const PictureFileOptions& options)
      : encoder_(std::move(encoder)) {
    appendChunk(tags_, "sRGB", {0});  // perceptual
    if (!options.dotsPerInch) return;
    constexpr double kInchesPerMetre = 1.0 / 0.0254;
    Bytes perMetre;
    const auto dots =
        static_cast<std::uint32_t>(std::lround(*options.dotsPerInch * kInchesPerMetre));
    appendBig32(perMetre, dots);
    appendBig32(perMetre, dots);
    perMetre.push_back(1);
    appendChunk(tags_, "pHYs", perMetre);
  }

  Result<Bytes> encode(const ImageView& picture) override {
    Result<Bytes> png = encoder_.encode(picture);
    if (!png) return png;
    constexpr std::ptrdiff_t kHeaderBytes = 8 + 25;  // the signature and IHDR
    // libav says pixels of no known shape by a pHYs of its own.
    removeChunk(*png, "pHYs");
    png->insert(png->begin() + kHeaderBytes, tags_.begin(), tags_.end());
    return png;
  }

 private:
  static void removeChunk(Bytes& png, std::string_view type) {
    constexpr std::size_t kSignatureBytes = 8;
    for (std::size_t at = kSignatureBytes; at + 12 <= png.size();) {
      const std::size_t length = std::size_t{png[at]} << 24U | std::size_t{png[at + 1]} << 16U |
                                 std::size_t{png[at + 2]} << 8U | png[at + 3];
      const auto from = png.begin() + static_cast<std::ptrdiff_t>(at);
      if (std::equal(type.begin(), type.end(), from + 4)) {
        png.erase(from, from + static_cast<std::ptrdiff_t>(length + 12));
        return;
      }
      at += length + 12;
    }
  }

  libav::PngEncoder encoder_;
  Bytes tags_;
};

}  // namespace

std::optional<PictureFileKind> writtenPictureKind(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  const auto found = std::ranges::find(kWrittenEndings, ending, &PictureEnding::text);
  if (found == kWrittenEndings.end()) return std::nullopt;
  return found->kind;
}

const std::string& writtenPictureEndings() {
  static const std::string kText = ".png, .jpg, .jpeg, .tif or .tiff";
  return kText;
}

Result<std::unique_ptr<PictureEncoder>> openPictureEncoder(PictureFileKind kind, FrameFormat format,
                                                           const PictureFileOptions& options) {
  if (format.pixelFormat != PixelFormat::kRgb8) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = "picture",
                                .problem = "cannot be written unless it is RGB"});
  }
  if (kind == PictureFileKind::kJpeg) return makeJpegEncoder(format, options);
  if (kind == PictureFileKind::kTiff) return makeTiffEncoder(format, options);
  Result<libav::PngEncoder> png = libav::PngEncoder::open(format);
  if (!png) return tl::unexpected(png.error());
  return std::make_unique<TaggedPng>(*std::move(png), options);
}

}  // namespace pleinair::hal
