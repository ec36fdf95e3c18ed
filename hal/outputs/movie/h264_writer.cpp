#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "hal/media/errors.h"
#include "hal/media/handles.h"
#include "hal/outputs/movie/movie_writer.h"
#include "hal/outputs/movie/muxer_io.h"

namespace pleinair::hal::movie {
namespace {

constexpr AVRational kMicroseconds = {1, 1'000'000};
constexpr AVRational kMilliseconds = {1, 1000};

// libav's Matroska muxer counts in milliseconds only. It is given microseconds for them, and the
// scale in the header says so: element TimestampScale (RFC 9559 §5.1.2.9), 10^6 ns to 10^3 ns.
constexpr std::array<std::uint8_t, 7> kMillisecondScale = {0x2A, 0xD7, 0xB1, 0x83,
                                                           0x0F, 0x42, 0x40};
constexpr std::array<std::uint8_t, 7> kMicrosecondScale = {0x2A, 0xD7, 0xB1, 0x83,
                                                           0x00, 0x03, 0xE8};

int toEven(int side) {
  return side + side % 2;
}

libav::CodecContext configureX264(const AVCodec& codec, const MovieFormat& format) {
  auto encoder = libav::owned<libav::CodecContext>(avcodec_alloc_context3(&codec));
  encoder->width = toEven(format.frame.size.width);
  encoder->height = toEven(format.frame.size.height);
  encoder->pix_fmt = AV_PIX_FMT_YUV420P;
  encoder->time_base = kMicroseconds;
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
  av_opt_set(encoder->priv_data, "preset", "veryfast", 0);
  // Half of the preset's: size and quality stay (to 0.01 % on a painted movie), 15 MB less at
  // 1280×720.
  av_opt_set_int(encoder->priv_data, "rc-lookahead", 5, 0);
  av_opt_set_double(encoder->priv_data, "crf", format.crf, 0);
  return encoder;
}

/// The I420 picture with its last column and row repeated up to the frame's even size.
void copyPadded(const ImageView& picture, AVFrame& frame) {
  for (int plane = 0; plane < 3; ++plane) {
    const int rows = planeRows(PixelFormat::kI420, plane, picture.format.size.height);
    const auto paddedWidth = rowBytes(PixelFormat::kI420, plane, frame.width);
    const int paddedRows = planeRows(PixelFormat::kI420, plane, frame.height);
    for (int y = 0; y < paddedRows; ++y) {
      const auto row = picture.row(plane, std::min(y, rows - 1));
      std::uint8_t* to = frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
      std::uint8_t* end = std::ranges::copy(row, to).out;
      std::fill(end, to + paddedWidth, row.back());
    }
  }
}

class H264Writer final : public MovieWriter {
 public:
  H264Writer(Container container, std::string subject, const MovieFormat& format, PendingFile& file,
             std::unique_ptr<SoundTrack> sound)
      : subject_(std::move(subject)),
        format_(format),
        container_(container),
        io_(file),
        sound_(std::move(sound)) {}

  Result<void> open();
  Result<void> write(const ImageView& picture, Duration time) override;
  Result<void> finish() override;

 private:
  Result<void> openEncoder();
  Result<void> openMuxer();
  Result<void> addSound();
  Result<void> drainEncoder();
  /// Writes the sound that begins before `end`, a time in kMicroseconds.
  Result<void> writeSound(std::int64_t end);
  /// libav's status, unless the file failed beneath it.
  Result<void> check(int status, const char* operation) const;

  std::string subject_;
  MovieFormat format_;
  Container container_;
  MuxerIo io_;
  libav::OutputContext muxer_;
  libav::CodecContext encoder_;
  libav::Packet packet_ = libav::makePacket();
  AVStream* stream_ = nullptr;  ///< the muxer's
  std::unique_ptr<SoundTrack> sound_;
  AVStream* soundStream_ = nullptr;  ///< the muxer's
  std::int64_t lastSoundTime_ = -1;  ///< in the muxer's time base
  std::int64_t lastTime_ = -1;       ///< in kMicroseconds
};

Result<void> H264Writer::check(int status, const char* operation) const {
  if (io_.failure()) return tl::unexpected(*io_.failure());
  if (status < 0) {
    return tl::unexpected(libav::libavError(subject_, operation, status, ErrorKind::kInternal));
  }
  return {};
}

Result<void> H264Writer::open() {
  if (Result<void> opened = openEncoder(); !opened) return opened;
  return openMuxer();
}

Result<void> H264Writer::openEncoder() {
  const AVCodec* codec = avcodec_find_encoder_by_name("libx264");
  if (codec == nullptr) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject_,
                                .problem = "this build's libav has no H.264 encoder (libx264)",
                                .remedy = "write .y4m, or install a libav with x264"});
  }
  encoder_ = configureX264(*codec, format_);
  return check(avcodec_open2(encoder_.get(), codec, nullptr), "cannot start the H.264 encoder");
}

Result<void> H264Writer::openMuxer() {
  const bool isMp4 = container_ == Container::kMp4;
  AVFormatContext* context = nullptr;
  int status =
      avformat_alloc_output_context2(&context, nullptr, isMp4 ? "mp4" : "matroska", nullptr);
  if (Result<void> allocated = check(status, "cannot start the muxer"); !allocated) {
    return allocated;
  }
  muxer_.reset(context);
  muxer_->pb = io_.context();
  muxer_->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
  stream_ = avformat_new_stream(muxer_.get(), nullptr);
  if (stream_ == nullptr) throw std::bad_alloc();
  status = avcodec_parameters_from_context(stream_->codecpar, encoder_.get());
  stream_->time_base = kMicroseconds;
  if (Result<void> added = addSound(); !added) return added;
  AVDictionary* raw = nullptr;
  if (isMp4) {
    av_dict_set(&raw, "movflags", "frag_keyframe+empty_moov+default_base_moof", 0);
    av_dict_set(&raw, "video_track_timescale", "1000000", 0);
  } else {
    io_.substituteInHeader(kMillisecondScale, kMicrosecondScale);
    av_dict_set(&raw, "write_crc32", "0", 0);  // which would be of the header before that
  }
  if (status >= 0) status = avformat_write_header(muxer_.get(), &raw);
  const libav::Dictionary unusedOptions(raw);
  const AVRational expected = isMp4 ? kMicroseconds : kMilliseconds;
  if (status >= 0 && av_cmp_q(stream_->time_base, expected) != 0) status = AVERROR_BUG;
  return check(status, "cannot write the header");
}

Result<void> H264Writer::addSound() {
  if (sound_ == nullptr) return {};
  soundStream_ = avformat_new_stream(muxer_.get(), nullptr);
  if (soundStream_ == nullptr) throw std::bad_alloc();
  const int status = avcodec_parameters_copy(soundStream_->codecpar, &sound_->coding());
  soundStream_->codecpar->codec_tag = 0;  // the containers have names of their own
  soundStream_->time_base = {1, std::max(sound_->coding().sample_rate, 1)};
  return check(status, "cannot add the sound");
}

Result<void> H264Writer::writeSound(std::int64_t end) {
  if (sound_ == nullptr) return {};
  const Duration until(av_rescale_q(end, kMicroseconds, {1, 1'000'000'000}));
  while (AVPacket* packet = sound_->nextBefore(until)) {
    // To the Matroska muxer, microseconds are given for milliseconds.
    const AVRational base = container_ == Container::kMkv ? kMicroseconds : soundStream_->time_base;
    av_packet_rescale_ts(packet, sound_->timeBase(), base);
    packet->pts = std::max(packet->pts, lastSoundTime_ + 1);
    packet->dts = packet->pts;
    lastSoundTime_ = packet->pts;
    packet->stream_index = soundStream_->index;
    packet->pos = -1;
    const int status = av_write_frame(muxer_.get(), packet);
    if (Result<void> written = check(status, "cannot write"); !written) return written;
  }
  return {};
}

Result<void> H264Writer::write(const ImageView& picture, Duration time) {
  libav::Frame frame = libav::makeFrame();
  frame->format = AV_PIX_FMT_YUV420P;
  frame->width = encoder_->width;
  frame->height = encoder_->height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  copyPadded(picture, *frame);
  const std::int64_t rounded = av_rescale_q(time.count(), {1, 1'000'000'000}, kMicroseconds);
  frame->pts = std::max(rounded, lastTime_ + 1);
  lastTime_ = frame->pts;
  const int status = avcodec_send_frame(encoder_.get(), frame.get());
  if (Result<void> sent = check(status, "cannot encode"); !sent) return sent;
  return drainEncoder();
}

Result<void> H264Writer::drainEncoder() {
  for (;;) {
    int status = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return {};
    if (Result<void> encoded = check(status, "cannot encode"); !encoded) return encoded;
    if (Result<void> written = writeSound(packet_->pts); !written) return written;
    packet_->stream_index = stream_->index;
    packet_->duration =
        av_rescale_q(format_.framePeriod.count(), {1, 1'000'000'000}, kMicroseconds);
    status = av_write_frame(muxer_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (Result<void> written = check(status, "cannot write"); !written) return written;
  }
}

Result<void> H264Writer::finish() {
  const int status = avcodec_send_frame(encoder_.get(), nullptr);
  if (Result<void> sent = check(status, "cannot encode"); !sent) return sent;
  if (Result<void> drained = drainEncoder(); !drained) return drained;
  // The sound ends with the last image.
  const std::int64_t period =
      av_rescale_q(format_.framePeriod.count(), {1, 1'000'000'000}, kMicroseconds);
  if (Result<void> written = writeSound(lastTime_ + period); !written) return written;
  const int ended = av_write_trailer(muxer_.get());
  avio_flush(io_.context());
  return check(ended, "cannot write");
}

}  // namespace

bool canHold(Container container, const AVCodecParameters& sound) {
  const AVCodecID coding = sound.codec_id;
  if (container == Container::kMp4) {
    // Their parts of the header are made of packets, which come after it.
    if (coding == AV_CODEC_ID_AC3 || coding == AV_CODEC_ID_EAC3) return false;
    if (coding == AV_CODEC_ID_AAC && sound.extradata_size == 0) return false;  // ADTS
  }
  const char* const name = container == Container::kMp4 ? "mp4" : "matroska";
  const AVOutputFormat* const format = av_guess_format(name, nullptr, nullptr);
  return format != nullptr && avformat_query_codec(format, coding, FF_COMPLIANCE_NORMAL) == 1;
}

Result<std::unique_ptr<MovieWriter>> openH264Writer(Container container, const MovieFormat& format,
                                                    const std::string& subject, PendingFile& file,
                                                    std::unique_ptr<SoundTrack> sound) {
  libav::redirectLog();
  auto writer = std::make_unique<H264Writer>(container, subject, format, file, std::move(sound));
  if (Result<void> opened = writer->open(); !opened) return tl::unexpected(opened.error());
  return writer;
}

}  // namespace pleinair::hal::movie
