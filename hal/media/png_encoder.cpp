#include "hal/media/png_encoder.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "hal/media/errors.h"

namespace pleinair::hal::libav {
namespace {

AVPixelFormat layoutOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::kRgb8:
      return AV_PIX_FMT_RGB24;
    case PixelFormat::kRgba8:
      return AV_PIX_FMT_RGBA;
    case PixelFormat::kGrey8:
      return AV_PIX_FMT_GRAY8;
    default:
      return AV_PIX_FMT_NONE;
  }
}

Error unsupported(std::string problem) {
  return Error{.kind = ErrorKind::kUnsupported, .subject = "PNG", .problem = std::move(problem)};
}

}  // namespace

PngEncoder::PngEncoder(CodecContext codec, FrameFormat format)
    : codec_(std::move(codec)), format_(format), packet_(makePacket()) {}

Result<PngEncoder> PngEncoder::open(FrameFormat format) {
  redirectLog();
  const AVPixelFormat layout = layoutOf(format.pixelFormat);
  if (layout == AV_PIX_FMT_NONE) {
    return tl::unexpected(unsupported("cannot hold " + std::string(toString(format.pixelFormat))));
  }
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_PNG);
  if (codec == nullptr) return tl::unexpected(unsupported("this build's libav has no encoder"));
  auto context = owned<CodecContext>(avcodec_alloc_context3(codec));
  context->width = format.size.width;
  context->height = format.size.height;
  context->pix_fmt = layout;
  context->time_base = {1, 25};
  context->compression_level = 1;
  context->thread_count = 1;
  av_opt_set(context->priv_data, "pred", "sub", 0);
  const int status = avcodec_open2(context.get(), codec, nullptr);
  if (status < 0) {
    return tl::unexpected(libavError("PNG", "cannot encode", status, ErrorKind::kInternal));
  }
  return PngEncoder(std::move(context), format);
}

Result<std::vector<std::uint8_t>> PngEncoder::encode(const ImageView& picture) {
  assert(picture.format == format_ && picture.isComplete());
  Frame frame = makeFrame();
  frame->format = codec_->pix_fmt;
  frame->width = format_.size.width;
  frame->height = format_.size.height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  for (int y = 0; y < format_.size.height; ++y) {
    std::ranges::copy(picture.row(0, y), frame->data[0] + std::ptrdiff_t{y} * frame->linesize[0]);
  }
  int status = avcodec_send_frame(codec_.get(), frame.get());
  if (status >= 0) status = avcodec_receive_packet(codec_.get(), packet_.get());
  if (status < 0) {
    return tl::unexpected(libavError("PNG", "cannot encode", status, ErrorKind::kInternal));
  }
  std::vector<std::uint8_t> bytes(packet_->data, packet_->data + packet_->size);
  av_packet_unref(packet_.get());
  return bytes;
}

}  // namespace pleinair::hal::libav
