#include "hal/media/heif_decoder.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <libheif/heif.h>

#include "hal/media/picture_decoder.h"

namespace pleinair::hal::libav {
namespace {

struct FreeHeif {
  void operator()(heif_context* context) const { heif_context_free(context); }
  void operator()(heif_image_handle* handle) const { heif_image_handle_release(handle); }
  void operator()(heif_image* image) const { heif_image_release(image); }
  void operator()(heif_color_profile_nclx* profile) const { heif_nclx_color_profile_free(profile); }
};
template <class T>
using Heif = std::unique_ptr<T, FreeHeif>;

Error heifError(const std::string& subject, const heif_error& error) {
  const bool isUnsupported =
      error.code == heif_error_Unsupported_filetype || error.code == heif_error_Unsupported_feature;
  return {.kind = isUnsupported ? ErrorKind::kUnsupported : ErrorKind::kInvalidInput,
          .subject = subject,
          .problem =
              std::string(isUnsupported ? "cannot be read by libheif: " : "is a broken picture: ") +
              error.message,
          .remedy = "convert it to PNG or JPEG"};
}

struct Layout {
  AVPixelFormat pixels;
  heif_chroma chroma;
  int bytesPerPixel;
};

Layout layoutOf(const heif_image_handle& handle) {
  const bool hasAlpha = heif_image_handle_has_alpha_channel(&handle) != 0;
  if (heif_image_handle_get_luma_bits_per_pixel(&handle) > 8) {
    if (hasAlpha) return {AV_PIX_FMT_RGBA64LE, heif_chroma_interleaved_RRGGBBAA_LE, 8};
    return {AV_PIX_FMT_RGB48LE, heif_chroma_interleaved_RRGGBB_LE, 6};
  }
  if (hasAlpha) {
    return {AV_PIX_FMT_RGBA, heif_chroma_interleaved_RGBA, 4};
  }
  return {AV_PIX_FMT_RGB24, heif_chroma_interleaved_RGB, 3};
}

/// libheif has samples of their own depth in 16-bit words; libav has them use all bits.
void copyRow(const std::uint8_t* from, std::uint8_t* to, std::size_t bytes, int depth) {
  if (depth <= 8) {
    std::copy_n(from, bytes, to);
    return;
  }
  for (std::size_t i = 0; i + 1 < bytes; i += 2) {
    const unsigned sample = from[i] | static_cast<unsigned>(from[i + 1]) << 8U;
    const unsigned all = sample << (16U - static_cast<unsigned>(depth)) |
                         sample >> (2U * static_cast<unsigned>(depth) - 16U);
    to[i] = static_cast<std::uint8_t>(all & 0xFFU);
    to[i + 1] = static_cast<std::uint8_t>(all >> 8U & 0xFFU);
  }
}

/// The codes are those of ITU-T H.273 in both libraries.
void tagColours(const heif_image_handle& handle, AVFrame& frame) {
  if (const std::size_t bytes = heif_image_handle_get_raw_color_profile_size(&handle); bytes > 0) {
    AVFrameSideData* const side = av_frame_new_side_data(&frame, AV_FRAME_DATA_ICC_PROFILE, bytes);
    if (side == nullptr) throw std::bad_alloc();
    if (heif_image_handle_get_raw_color_profile(&handle, side->data).code != heif_error_Ok) {
      av_frame_remove_side_data(&frame, AV_FRAME_DATA_ICC_PROFILE);
    }
  }
  heif_color_profile_nclx* raw = nullptr;
  if (heif_image_handle_get_nclx_color_profile(&handle, &raw).code != heif_error_Ok) return;
  const Heif<heif_color_profile_nclx> profile(raw);
  frame.color_primaries = static_cast<AVColorPrimaries>(profile->color_primaries);
  frame.color_trc = static_cast<AVColorTransferCharacteristic>(profile->transfer_characteristics);
}

}  // namespace

Result<std::shared_ptr<const AVFrame>> decodeHeif(std::span<const std::uint8_t> bytes,
                                                  const std::string& subject) {
  const Heif<heif_context> context(heif_context_alloc());
  if (context == nullptr) throw std::bad_alloc();
  heif_error status = heif_context_read_from_memory_without_copy(context.get(), bytes.data(),
                                                                 bytes.size(), nullptr);
  heif_image_handle* rawHandle = nullptr;
  if (status.code == heif_error_Ok) {
    status = heif_context_get_primary_image_handle(context.get(), &rawHandle);
  }
  if (status.code != heif_error_Ok) return tl::unexpected(heifError(subject, status));
  const Heif<heif_image_handle> handle(rawHandle);
  const FrameSize announced{heif_image_handle_get_width(handle.get()),
                            heif_image_handle_get_height(handle.get())};
  if (!isAcceptedSize(announced)) return tl::unexpected(tooLarge(subject, announced));
  const Layout layout = layoutOf(*handle);
  heif_image* rawImage = nullptr;
  status = heif_decode_image(handle.get(), &rawImage, heif_colorspace_RGB, layout.chroma, nullptr);
  if (status.code != heif_error_Ok) return tl::unexpected(heifError(subject, status));
  const Heif<heif_image> image(rawImage);
  int stride = 0;
  const std::uint8_t* const plane =
      heif_image_get_plane_readonly(image.get(), heif_channel_interleaved, &stride);
  const FrameSize size{heif_image_get_width(image.get(), heif_channel_interleaved),
                       heif_image_get_height(image.get(), heif_channel_interleaved)};
  if (plane == nullptr || !isAcceptedSize(size)) return tl::unexpected(tooLarge(subject, size));
  Frame frame = makeFrame();
  frame->format = layout.pixels;
  frame->width = size.width;
  frame->height = size.height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  tagColours(*handle, *frame);
  const int depth = heif_image_get_bits_per_pixel_range(image.get(), heif_channel_interleaved);
  const auto rowBytes =
      static_cast<std::size_t>(size.width) * static_cast<std::size_t>(layout.bytesPerPixel);
  for (int y = 0; y < size.height; ++y) {
    copyRow(plane + std::ptrdiff_t{y} * stride,
            frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0], rowBytes, depth);
  }
  return std::shared_ptr<const AVFrame>(std::move(frame));
}

}  // namespace pleinair::hal::libav
