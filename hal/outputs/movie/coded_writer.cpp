#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <utility>

#include "hal/media/errors.h"
#include "hal/media/handles.h"
#include "hal/outputs/movie/movie_writer.h"
#include "hal/outputs/movie/muxer_io.h"
#include "hal/outputs/movie/video_encoder.h"

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

class CodedWriter final : public MovieWriter {
 public:
  CodedWriter(Container container, std::string subject, const MovieFormat& format,
              PendingFile& file, std::unique_ptr<SoundSource> sound)
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
  std::unique_ptr<SoundSource> sound_;
  AVStream* soundStream_ = nullptr;  ///< the muxer's
  std::int64_t lastSoundTime_ = -1;  ///< in the muxer's time base
  std::int64_t lastTime_ = -1;       ///< in kMicroseconds
};

Result<void> CodedWriter::check(int status, const char* operation) const {
  if (io_.failure()) return tl::unexpected(*io_.failure());
  if (status < 0) {
    return tl::unexpected(libav::libavError(subject_, operation, status, ErrorKind::kInternal));
  }
  return {};
}

Result<void> CodedWriter::open() {
  if (Result<void> opened = openEncoder(); !opened) return opened;
  return openMuxer();
}

Result<void> CodedWriter::openEncoder() {
  Result<libav::CodecContext> encoder = openVideoEncoder(format_, subject_);
  if (!encoder) return tl::unexpected(encoder.error());
  encoder_ = *std::move(encoder);
  return {};
}

Result<void> CodedWriter::openMuxer() {
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
  if (!isMp4) stream_->codecpar->codec_tag = 0;  // a name of MP4's
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

Result<void> CodedWriter::addSound() {
  if (sound_ == nullptr) return {};
  soundStream_ = avformat_new_stream(muxer_.get(), nullptr);
  if (soundStream_ == nullptr) throw std::bad_alloc();
  const int status = avcodec_parameters_copy(soundStream_->codecpar, &sound_->coding());
  soundStream_->codecpar->codec_tag = 0;  // the containers have names of their own
  soundStream_->time_base = {1, std::max(sound_->coding().sample_rate, 1)};
  return check(status, "cannot add the sound");
}

Result<void> CodedWriter::writeSound(std::int64_t end) {
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

Result<void> CodedWriter::write(const ImageView& picture, Duration time) {
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

Result<void> CodedWriter::drainEncoder() {
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

Result<void> CodedWriter::finish() {
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

Result<std::unique_ptr<MovieWriter>> openCodedWriter(Container container, const MovieFormat& format,
                                                     const std::string& subject, PendingFile& file,
                                                     std::unique_ptr<SoundSource> sound) {
  libav::redirectLog();
  auto writer = std::make_unique<CodedWriter>(container, subject, format, file, std::move(sound));
  if (Result<void> opened = writer->open(); !opened) return tl::unexpected(opened.error());
  return writer;
}

}  // namespace pleinair::hal::movie
