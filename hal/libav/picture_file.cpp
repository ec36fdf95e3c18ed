#include "hal/libav/picture_file.h"

#include "hal/libav/frame_pixels.h"
#include "hal/libav/picture_decoder.h"
#include "hal/libav/png_encoder.h"
#include "hal/pending_file.h"

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

Result<std::vector<std::uint8_t>> encodePng(const ImageView& picture) {
  Result<libav::PngEncoder> encoder = libav::PngEncoder::open(picture.format);
  if (!encoder) return tl::unexpected(encoder.error());
  return encoder->encode(picture);
}

Result<void> writePng(const std::filesystem::path& path, const ImageView& picture) {
  const Result<std::vector<std::uint8_t>> bytes = encodePng(picture);
  if (!bytes) return tl::unexpected(bytes.error());
  Result<PendingFile> file = PendingFile::create(path);
  if (!file) return tl::unexpected(file.error());
  if (Result<void> written = file->write(*bytes); !written) return written;
  return file->publish();
}

}  // namespace pleinair::hal
