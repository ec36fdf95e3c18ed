#include "hal/outputs/movie/video_encoder.h"

#include <string_view>

#include "hal/media/errors.h"

namespace pleinair::hal::movie {
namespace {

/// An encoder and what it is set to.
struct EncoderChoice {
  const char* encoder;  ///< libav's name
  std::string_view name;
  double crf;  ///< where none is asked for
};

EncoderChoice choiceOf(VideoCodec codec) {
  switch (codec) {
    case VideoCodec::kHevc:
      return {.encoder = "libx265", .name = "HEVC", .crf = 22};
    case VideoCodec::kAv1:
      return {.encoder = "libaom-av1", .name = "AV1", .crf = 26};
    case VideoCodec::kFfv1:
      return {.encoder = "ffv1", .name = "FFV1", .crf = 0};
    case VideoCodec::kH264:
      break;
  }
  return {.encoder = "libx264", .name = "H.264", .crf = 18};
}

int toEven(int side) {
  return side + side % 2;
}

void setX264(AVCodecContext& encoder) {
  av_opt_set(encoder.priv_data, "preset", "veryfast", 0);
  // Half of the preset's: size and quality stay (to 0.01 % on a painted movie), 15 MB less at
  // 1280×720.
  av_opt_set_int(encoder.priv_data, "rc-lookahead", 5, 0);
}

void setX265(AVCodecContext& encoder) {
  av_opt_set(encoder.priv_data, "preset", "veryfast", 0);
  // Its own log goes to standard error. The result depends on the frame threads.
  av_opt_set(encoder.priv_data, "x265-params", "log-level=none:frame-threads=1:pools=2:bframes=0",
             0);
  encoder.codec_tag = MKTAG('h', 'v', 'c', '1');  // the name that all players of MP4 know
}

void setAom(AVCodecContext& encoder) {
  av_opt_set_int(encoder.priv_data, "cpu-used", 6, 0);
  av_opt_set_int(encoder.priv_data, "row-mt", 1, 0);
}

void setFfv1(AVCodecContext& encoder) {
  encoder.level = 3;  // slices, each with a checksum
  encoder.slices = 4;
  encoder.gop_size = 1;
}

}  // namespace

Result<libav::CodecContext> openVideoEncoder(const MovieFormat& format,
                                             const std::string& subject) {
  const EncoderChoice choice = choiceOf(format.codec);
  const AVCodec* codec = avcodec_find_encoder_by_name(choice.encoder);
  if (codec == nullptr) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = "this build's libav has no encoder of " +
                                           std::string(choice.name) + " (" + choice.encoder + ")",
                                .remedy = "write .y4m, or give another --codec"});
  }
  auto encoder = libav::owned<libav::CodecContext>(avcodec_alloc_context3(codec));
  encoder->width = toEven(format.frame.size.width);
  encoder->height = toEven(format.frame.size.height);
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->time_base = {1, 1'000'000};
  encoder->color_range = AVCOL_RANGE_MPEG;
  const bool isHd = format.frame.encoding.matrix == ColorMatrix::kBt709;
  encoder->colorspace = isHd ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M;
  encoder->color_primaries = isHd ? AVCOL_PRI_BT709 : AVCOL_PRI_SMPTE170M;
  encoder->color_trc = isHd ? AVCOL_TRC_BT709 : AVCOL_TRC_SMPTE170M;
  encoder->gop_size = 60;
  // Without B frames every player sees the first frame at time zero.
  encoder->max_b_frames = 0;
  // The result depends on the number of threads, so it is not the machine's. Each keeps pictures of
  // its own (11 MB at 1280×720), and painting takes far longer than encoding does.
  encoder->thread_count = 2;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  if (format.codec == VideoCodec::kH264) setX264(*encoder);
  if (format.codec == VideoCodec::kHevc) setX265(*encoder);
  if (format.codec == VideoCodec::kAv1) setAom(*encoder);
  if (format.codec == VideoCodec::kFfv1) setFfv1(*encoder);
  const double crf = format.crf.value_or(choice.crf);
  if (format.codec == VideoCodec::kAv1) {
    av_opt_set_int(encoder->priv_data, "crf", static_cast<std::int64_t>(crf + 0.5), 0);
  } else if (format.codec != VideoCodec::kFfv1) {
    av_opt_set_double(encoder->priv_data, "crf", crf, 0);
  }
  const int status = avcodec_open2(encoder.get(), codec, nullptr);
  if (status < 0) {
    return tl::unexpected(
        libav::libavError(subject, "cannot start the encoder of " + std::string(choice.name),
                          status, ErrorKind::kInternal));
  }
  return encoder;
}

}  // namespace pleinair::hal::movie
