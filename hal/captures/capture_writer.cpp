#include "hal/captures/capture_writer.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <string>
#include <utility>

#include "hal/captures/capture_tags.h"
#include "hal/captures/frame_facts.h"
#include "hal/captures/stored_pixels.h"
#include "hal/media/errors.h"
#include "hal/media/handles.h"
#include "hal/outputs/movie/muxer_io.h"
#include "hal/pending_file.h"

namespace pleinair::hal::captures {
namespace {

constexpr AVRational kMicroseconds = {1, 1'000'000};
// As in hal/outputs/movie/h264_writer.cpp: libav's muxer counts in milliseconds, the file in µs.
constexpr std::array<std::uint8_t, 7> kMillisecondScale = {0x2A, 0xD7, 0xB1, 0x83,
                                                           0x0F, 0x42, 0x40};
constexpr std::array<std::uint8_t, 7> kMicrosecondScale = {0x2A, 0xD7, 0xB1, 0x83,
                                                           0x00, 0x03, 0xE8};

libav::CodecContext configureFfv1(const AVCodec& codec, const FrameFormat& format) {
  auto encoder = libav::owned<libav::CodecContext>(avcodec_alloc_context3(&codec));
  encoder->width = format.size.width;
  encoder->height = format.size.height;
  encoder->pix_fmt = storedFormat(format.pixelFormat);
  encoder->time_base = kMicroseconds;
  if (isYCbCr(format.pixelFormat)) {
    const bool isHd = format.encoding.matrix == ColorMatrix::kBt709;
    encoder->colorspace = isHd ? AVCOL_SPC_BT709 : AVCOL_SPC_SMPTE170M;
    encoder->color_range =
        format.encoding.range == ColorRange::kFull ? AVCOL_RANGE_JPEG : AVCOL_RANGE_MPEG;
  }
  encoder->gop_size = 1;  // a frame that is damaged damages no other
  encoder->thread_count = 4;
  encoder->thread_type = FF_THREAD_SLICE;  // frames are not held back
  encoder->level = 3;
  // libav cuts no chroma sample in two.
  encoder->slices = format.size.width % 4 == 0 && format.size.height % 4 == 0 ? 4 : 1;
  encoder->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  av_opt_set_int(encoder->priv_data, "slicecrc", 1, 0);
  av_opt_set_int(encoder->priv_data, "coder", 0, 0);  // Golomb-Rice: the fastest
  return encoder;
}

class FileWriter final : public CaptureWriter {
 public:
  FileWriter(std::string subject, CaptureHeader header, TimePoint start, PendingFile file)
      : subject_(std::move(subject)),
        header_(std::move(header)),
        start_(start),
        file_(std::move(file)),
        io_(file_) {}

  Result<void> begin();
  Result<void> write(const CapturedFrame& frame) override;
  Result<void> finish() override;

 private:
  Result<void> openEncoder();
  Result<void> openMuxer();
  AVStream* addTrack();
  void tagStream();
  Result<void> writeFacts(const FrameFacts& facts, std::int64_t time);
  Result<void> drainEncoder();
  /// libav's status, unless the file failed beneath it.
  Result<void> check(int status, const char* operation) const;
  std::int64_t duration() const;

  std::string subject_;
  CaptureHeader header_;
  TimePoint start_;
  PendingFile file_;
  movie::MuxerIo io_;
  libav::OutputContext muxer_;
  libav::CodecContext encoder_;
  libav::Packet packet_ = libav::makePacket();
  AVStream* video_ = nullptr;   ///< the muxer's
  AVStream* facts_ = nullptr;   ///< the muxer's
  std::int64_t lastTime_ = -1;  ///< in kMicroseconds
};

Result<void> FileWriter::check(int status, const char* operation) const {
  if (io_.failure()) return tl::unexpected(*io_.failure());
  if (status < 0) {
    return tl::unexpected(libav::libavError(subject_, operation, status, ErrorKind::kInternal));
  }
  return {};
}

Result<void> FileWriter::begin() {
  if (Result<void> opened = openEncoder(); !opened) return opened;
  return openMuxer();
}

Result<void> FileWriter::openEncoder() {
  const AVCodec* codec = avcodec_find_encoder(AV_CODEC_ID_FFV1);
  if (codec == nullptr) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject_,
                                .problem = "this build's libav has no FFV1 encoder",
                                .remedy = "record without --lossless"});
  }
  encoder_ = configureFfv1(*codec, header_.format.frame);
  return check(avcodec_open2(encoder_.get(), codec, nullptr), "cannot start the FFV1 encoder");
}

AVStream* FileWriter::addTrack() {
  AVStream* const track = avformat_new_stream(muxer_.get(), nullptr);
  if (track == nullptr) throw std::bad_alloc();
  track->time_base = kMicroseconds;
  return track;
}

void FileWriter::tagStream() {
  const auto set = [&](const char* tag, const std::string& text) {
    if (!text.empty()) av_dict_set(&video_->metadata, tag, text.c_str(), 0);
  };
  set(kLayoutTag, std::string(toString(header_.format.frame.pixelFormat)));
  if (header_.format.framePeriod) {
    set(kPeriodTag, std::to_string(header_.format.framePeriod->count()));
  }
  set(kCameraTag,
      header_.camera.backend + ":" + header_.camera.id + " (" + header_.camera.description + ")");
  set(kRequestTag, header_.request);
}

Result<void> FileWriter::openMuxer() {
  AVFormatContext* context = nullptr;
  int status = avformat_alloc_output_context2(&context, nullptr, "matroska", nullptr);
  if (Result<void> allocated = check(status, "cannot start the muxer"); !allocated) {
    return allocated;
  }
  muxer_.reset(context);
  muxer_->pb = io_.context();
  muxer_->flags |= AVFMT_FLAG_CUSTOM_IO | AVFMT_FLAG_BITEXACT;
  video_ = addTrack();
  status = avcodec_parameters_from_context(video_->codecpar, encoder_.get());
  tagStream();
  facts_ = addTrack();
  facts_->codecpar->codec_type = AVMEDIA_TYPE_SUBTITLE;
  facts_->codecpar->codec_id = AV_CODEC_ID_SUBRIP;
  facts_->disposition = 0;  // players do not show it unless they are asked to
  io_.substituteInHeader(kMillisecondScale, kMicrosecondScale);
  AVDictionary* raw = nullptr;
  av_dict_set(&raw, "write_crc32", "0", 0);  // which would be of the header before that
  av_dict_set(&raw, "default_mode", "infer_no_subs", 0);
  if (status >= 0) status = avformat_write_header(muxer_.get(), &raw);
  const libav::Dictionary unusedOptions(raw);
  return check(status, "cannot write the header");
}

std::int64_t FileWriter::duration() const {
  const Duration period = header_.format.framePeriod.value_or(std::chrono::milliseconds(40));
  return std::max<std::int64_t>(av_rescale_q(period.count(), {1, 1'000'000'000}, kMicroseconds), 1);
}

Result<void> FileWriter::writeFacts(const FrameFacts& facts, std::int64_t time) {
  const std::string text = textOf(facts);
  if (av_new_packet(packet_.get(), static_cast<int>(text.size())) < 0) throw std::bad_alloc();
  std::memcpy(packet_->data, text.data(), text.size());
  packet_->stream_index = facts_->index;
  packet_->pts = packet_->dts = time;
  packet_->duration = duration();
  packet_->flags |= AV_PKT_FLAG_KEY;
  const int status = av_write_frame(muxer_.get(), packet_.get());
  av_packet_unref(packet_.get());
  return check(status, "cannot write");
}

Result<void> FileWriter::write(const CapturedFrame& captured) {
  assert(captured.image.format == header_.format.frame);
  const FrameFacts facts = factsOf(captured, start_);
  const std::int64_t rounded = av_rescale_q(facts.time.count(), {1, 1'000'000'000}, kMicroseconds);
  lastTime_ = std::max(rounded, lastTime_ + 1);
  if (Result<void> written = writeFacts(facts, lastTime_); !written) return written;

  libav::Frame frame = libav::makeFrame();
  frame->format = encoder_->pix_fmt;
  frame->width = encoder_->width;
  frame->height = encoder_->height;
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  store(captured.image.map().view(), *frame);
  frame->pts = lastTime_;
  const int status = avcodec_send_frame(encoder_.get(), frame.get());
  if (Result<void> sent = check(status, "cannot encode"); !sent) return sent;
  return drainEncoder();
}

Result<void> FileWriter::drainEncoder() {
  for (;;) {
    int status = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (status == AVERROR(EAGAIN) || status == AVERROR_EOF) return {};
    if (Result<void> encoded = check(status, "cannot encode"); !encoded) return encoded;
    packet_->stream_index = video_->index;
    packet_->duration = duration();
    status = av_write_frame(muxer_.get(), packet_.get());
    av_packet_unref(packet_.get());
    if (Result<void> written = check(status, "cannot write"); !written) return written;
  }
}

Result<void> FileWriter::finish() {
  const int sent = avcodec_send_frame(encoder_.get(), nullptr);
  if (Result<void> done = check(sent, "cannot encode"); !done) return done;
  if (Result<void> drained = drainEncoder(); !drained) return drained;
  const int ended = av_write_trailer(muxer_.get());
  avio_flush(io_.context());
  if (Result<void> done = check(ended, "cannot write"); !done) return done;
  return file_.publish();
}

}  // namespace

Result<std::unique_ptr<CaptureWriter>> CaptureWriter::open(const std::filesystem::path& path,
                                                           const CaptureHeader& header,
                                                           TimePoint start) {
  libav::redirectLog();
  Result<PendingFile> file = PendingFile::create(path);
  if (!file) return tl::unexpected(file.error());
  auto writer = std::make_unique<FileWriter>(path.string(), header, start, *std::move(file));
  if (Result<void> begun = writer->begin(); !begun) return tl::unexpected(begun.error());
  return writer;
}

}  // namespace pleinair::hal::captures
