#include "hal/media/picture_file.h"

#include "hal/media/frame_pixels.h"
#include "hal/media/picture_decoder.h"

namespace pleinair::hal {
namespace {

Result<Image> read(const std::filesystem::path& path, libav::Delivery delivery) {
  const Result<std::shared_ptr<const AVFrame>> frame = libav::decodePicture(path);
  if (!frame) return tl::unexpected(frame.error());
  Result<libav::LentPicture> picture = libav::lendPicture(*frame, delivery);
  if (!picture) {
    picture.error().subject = path.string();
    return tl::unexpected(picture.error());
  }
  return Image(picture->view);
}

}  // namespace

Result<Image> readPicture(const std::filesystem::path& path) {
  return read(path, libav::Delivery::kAsStored);
}

Result<Image> readPictureRgb(const std::filesystem::path& path) {
  return read(path, libav::Delivery::kRgb);
}

Result<Image> readPictureRgba(const std::filesystem::path& path) {
  return read(path, libav::Delivery::kRgba);
}

Result<Image> decodeRgba(std::span<const std::uint8_t> bytes, const std::string& subject) {
  const Result<std::shared_ptr<const AVFrame>> frame = libav::decodePicture(bytes, subject);
  if (!frame) return tl::unexpected(frame.error());
  Result<libav::LentPicture> picture = libav::lendPicture(*frame, libav::Delivery::kRgba);
  if (!picture) {
    picture.error().subject = subject;
    return tl::unexpected(picture.error());
  }
  return Image(picture->view);
}

Result<Rgb16Image> readRgb16(const std::filesystem::path& path) {
  const Result<std::shared_ptr<const AVFrame>> decoded = libav::decodePicture(path);
  if (!decoded) return tl::unexpected(decoded.error());
  const AVFrame& frame = **decoded;
  const bool isBigEndian = frame.format == AV_PIX_FMT_RGB48BE;
  if (!isBigEndian && frame.format != AV_PIX_FMT_RGB48LE) {
    return tl::unexpected(Error{.kind = ErrorKind::kInvalidInput,
                                .subject = path.string(),
                                .problem = "is no picture of 16-bit RGB",
                                .remedy = "give a PNG of 16 bits a channel, without alpha"});
  }
  Rgb16Image picture{.size = {frame.width, frame.height}, .rgb = {}};
  const std::size_t rowSamples = 3 * static_cast<std::size_t>(frame.width);
  picture.rgb.reserve(rowSamples * static_cast<std::size_t>(frame.height));
  for (int y = 0; y < frame.height; ++y) {
    const std::uint8_t* row = frame.data[0] + std::ptrdiff_t{y} * frame.linesize[0];
    for (std::size_t i = 0; i < rowSamples; ++i) {
      const unsigned high = row[2 * i + (isBigEndian ? 0 : 1)];
      const unsigned low = row[2 * i + (isBigEndian ? 1 : 0)];
      picture.rgb.push_back(static_cast<std::uint16_t>(high << 8U | low));
    }
  }
  return picture;
}

}  // namespace pleinair::hal
