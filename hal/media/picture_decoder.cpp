#include "hal/media/picture_decoder.h"

#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "hal/media/errors.h"
#include "hal/media/heif_decoder.h"
#include "hal/media/picture_header.h"

namespace pleinair::hal::libav {
namespace {

/// An upper bound on the file size of a valid picture within the size limits, even uncompressed at
/// 16 bits.
constexpr std::int64_t kMaxPictureFileBytes = 512'000'000;

AVCodecID codecOf(PictureKind kind) {
  switch (kind) {
    case PictureKind::kPng:
      return AV_CODEC_ID_PNG;
    case PictureKind::kJpeg:
      return AV_CODEC_ID_MJPEG;
    case PictureKind::kBmp:
      return AV_CODEC_ID_BMP;
    case PictureKind::kTiff:
      return AV_CODEC_ID_TIFF;
    case PictureKind::kWebp:
      return AV_CODEC_ID_WEBP;
    case PictureKind::kHeif:
      break;  // libheif's
    case PictureKind::kPnm:
      // libav has one decoder for all PNM types, which reads the type from the file
      return AV_CODEC_ID_PPM;
  }
  return AV_CODEC_ID_NONE;
}

Error broken(const std::string& subject, std::string problem) {
  return Error{.kind = ErrorKind::kInvalidInput,
               .subject = subject,
               .problem = std::move(problem),
               .remedy = "give a complete PNG or JPEG picture"};
}

Result<Packet> readWhole(const FileInput& file, const std::string& subject) {
  if (file.sizeBytes() > kMaxPictureFileBytes) {
    return tl::unexpected(broken(subject, "is too large a file for a picture"));
  }
  Packet packet = makePacket();
  const auto size = static_cast<int>(file.sizeBytes());
  if (av_new_packet(packet.get(), size) < 0) throw std::bad_alloc();
  const std::int64_t got = file.readAt(0, packet->data, static_cast<std::size_t>(size));
  if (got < 0) {
    return tl::unexpected(errnoError(subject, "cannot read", static_cast<int>(-got)));
  }
  if (got != size) return tl::unexpected(broken(subject, "was truncated while it was read"));
  return packet;
}

Result<PictureKind> checkHeader(std::span<const std::uint8_t> bytes, const std::string& subject) {
  const std::optional<PictureKind> kind = pictureKindOf(bytes);
  if (!kind) return tl::unexpected(broken(subject, "is not in a supported picture format"));
  if (const std::optional<FrameSize> size = peekPictureSize(*kind, bytes)) {
    if (size->width < 1 || size->height < 1) {
      return tl::unexpected(broken(subject, "is a broken picture: its size is zero"));
    }
    if (!isAcceptedSize(*size)) return tl::unexpected(tooLarge(subject, *size));
  }
  if (const auto flaw = defectOf(*kind, bytes)) {
    return tl::unexpected(broken(subject, "is a broken picture: it " + std::string(*flaw)));
  }
  return *kind;
}

CodecContext openPictureDecoder(AVCodecID id) {
  const AVCodec* codec = avcodec_find_decoder(id);
  if (codec == nullptr) return nullptr;
  auto decoder = owned<CodecContext>(avcodec_alloc_context3(codec));
  decoder->err_recognition = AV_EF_CRCCHECK | AV_EF_BITSTREAM | AV_EF_BUFFER;
  // To libav's TIFF decoder each tag that it does not use, such as the resolution, would be an
  // error.
  if (id != AV_CODEC_ID_TIFF) decoder->err_recognition |= AV_EF_EXPLODE;
  decoder->max_pixels = kMaxPixels;
  decoder->thread_count = 1;  // keeps its log lines on this thread
  return avcodec_open2(decoder.get(), codec, nullptr) < 0 ? nullptr : std::move(decoder);
}

Result<std::shared_ptr<const AVFrame>> decode(const AVPacket& packet, const std::string& subject) {
  redirectLog();
  const std::span<const std::uint8_t> bytes(packet.data, static_cast<std::size_t>(packet.size));
  const Result<PictureKind> kind = checkHeader(bytes, subject);
  if (!kind) return tl::unexpected(kind.error());

  if (*kind == PictureKind::kHeif) return decodeHeif(bytes, subject);
  const LogCapture log;
  const CodecContext decoder = openPictureDecoder(codecOf(*kind));
  if (decoder == nullptr) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = "this build's libav has no decoder for it",
                                .remedy = "convert it to PNG"});
  }
  Frame frame = makeFrame();
  int status = avcodec_send_packet(decoder.get(), &packet);
  if (status >= 0) status = avcodec_send_packet(decoder.get(), nullptr);
  if (status >= 0) status = avcodec_receive_frame(decoder.get(), frame.get());
  // The decoder filled the missing parts in if it logged an error.
  if (!log.firstError().empty()) {
    return tl::unexpected(broken(subject, "is a broken picture: " + log.firstError()));
  }
  if (status < 0) {
    return tl::unexpected(libavError(subject, "is a broken picture", status,
                                     ErrorKind::kInvalidInput,
                                     "give a complete PNG or JPEG picture"));
  }
  const FrameSize size{frame->width, frame->height};
  if (!isAcceptedSize(size)) return tl::unexpected(tooLarge(subject, size));
  // Resolutions in pictures' files are of no use to image viewers either.
  frame->sample_aspect_ratio = {0, 1};
  return std::shared_ptr<const AVFrame>(std::move(frame));
}

}  // namespace

Error tooLarge(std::string subject, FrameSize size) {
  return Error{.kind = ErrorKind::kUnsupported,
               .subject = std::move(subject),
               .problem = "size of " + std::to_string(size.width) + "x" +
                          std::to_string(size.height) + " px is beyond the limits",
               .remedy = "give at most " + std::to_string(kMaxSidePixels) + " px a side and " +
                         std::to_string(kMaxPixels / 1'000'000) + " Mpx"};
}

Result<std::shared_ptr<const AVFrame>> decodePicture(const std::filesystem::path& path) {
  const std::string subject = path.string();
  const Result<FileInput> file = FileInput::open(path);
  if (!file) return tl::unexpected(file.error());
  const Result<Packet> packet = readWhole(*file, subject);
  if (!packet) return tl::unexpected(packet.error());
  return decode(**packet, subject);
}

Result<std::shared_ptr<const AVFrame>> decodePicture(std::span<const std::uint8_t> bytes,
                                                     const std::string& subject) {
  if (std::cmp_greater(bytes.size(), kMaxPictureFileBytes)) {
    return tl::unexpected(broken(subject, "is too large a file for a picture"));
  }
  const Packet packet = makePacket();  // a padded copy: libav reads a little beyond the end
  if (av_new_packet(packet.get(), static_cast<int>(bytes.size())) < 0) throw std::bad_alloc();
  if (!bytes.empty()) std::memcpy(packet->data, bytes.data(), bytes.size());
  return decode(*packet, subject);
}

}  // namespace pleinair::hal::libav
