#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "hal/cameras/recording/frame_source.h"
#include "hal/captures/capture_tags.h"
#include "hal/captures/frame_facts.h"
#include "hal/captures/stored_pixels.h"
#include "hal/media/container_scan.h"
#include "hal/media/demuxer_io.h"
#include "hal/media/demuxing.h"
#include "hal/media/errors.h"
#include "hal/media/file_input.h"
#include "hal/media/picture_decoder.h"

namespace pleinair::hal::recording {
namespace {

constexpr std::string_view kRemedy = "give a movie with a video track, such as MP4, MKV or Y4M";

/// libav's demuxers that read other files or the network. A DemuxerIo lets them
/// open none; they are refused by name, so that the error gives the reason.
constexpr std::array<std::string_view, 8> kPlaylists = {"hls",  "concat", "dash",   "sdp",
                                                        "rtsp", "imf",    "image2", "tty"};

Error broken(const std::string& subject, std::string problem) {
  return Error{.kind = ErrorKind::kInvalidInput,
               .subject = subject,
               .problem = std::move(problem),
               .remedy = std::string(kRemedy)};
}

Error aborted(const std::string& subject, std::string problem) {
  return Error{.kind = ErrorKind::kInvalidInput,
               .subject = subject,
               .problem = std::move(problem),
               .remedy = "record or copy it again if it should be complete"};
}

/// An error with libav's own message, if it logged one.
Error broken(const std::string& subject, const std::string& problem, int code,
             const libav::LogCapture& log) {
  Error error =
      libav::libavError(subject, problem, code, ErrorKind::kInvalidInput, std::string(kRemedy));
  if (!log.firstError().empty() && error.kind == ErrorKind::kInvalidInput) {
    error.problem = problem + ": " + log.firstError();
  }
  return error;
}

bool isOneOf(const char* formatNames, std::string_view name) {
  return av_match_name(std::string(name).c_str(), formatNames) != 0;
}

struct DemuxedFile {
  libav::DemuxerIo io;
  libav::InputContext context;
  AVStream* stream = nullptr;  ///< owned by the context
  AVStream* facts = nullptr;   ///< the same; of a captured stream only
  std::string complaint;       ///< libav's first error line while it opened a file successfully
};

Result<void> openContainer(DemuxedFile& file, const std::string& subject) {
  const libav::LogCapture log;
  const AVInputFormat* format = nullptr;
  int status = av_probe_input_buffer2(file.io.context(), &format, "", nullptr, 0, 0);
  if (status < 0) {
    return tl::unexpected(broken(subject, "is not in a supported movie format"));
  }
  const bool isPlaylist = std::ranges::any_of(
      kPlaylists, [&](std::string_view name) { return isOneOf(format->name, name); });
  if (isPlaylist) {
    return tl::unexpected(broken(subject, "is a playlist or a text, not a movie"));
  }
  libav::leaveOutCutHead(file.io, *format);
  AVFormatContext* context = libav::makeDemuxer(file.io.context());
  status = avformat_open_input(&context, "", format, nullptr);  // frees the context on failure
  if (status < 0) {
    return tl::unexpected(broken(subject, "is a broken movie", status, log));
  }
  file.context.reset(context);
  file.complaint = log.firstError();
  return {};
}

/// Checks the size in each stream's header before decoding.
Result<void> checkSizes(const DemuxedFile& file, const std::string& subject) {
  for (unsigned i = 0; i < file.context->nb_streams; ++i) {
    const AVCodecParameters& parameters = *file.context->streams[i]->codecpar;
    const FrameSize size{parameters.width, parameters.height};
    if (parameters.codec_type != AVMEDIA_TYPE_VIDEO || (size.width == 0 && size.height == 0)) {
      continue;
    }
    if (size.width < 1 || size.height < 1) {
      return tl::unexpected(broken(subject, "is a broken movie: its size is zero"));
    }
    if (!isAcceptedSize(size)) return tl::unexpected(libav::tooLarge(subject, size));
  }
  return {};
}

Result<void> findStreams(DemuxedFile& file, const std::string& subject) {
  const libav::LogCapture log;
  const int status = libav::findStreamInfo(*file.context);
  if (status < 0) return tl::unexpected(broken(subject, "is a broken movie", status, log));
  return checkSizes(file, subject);
}

Result<libav::CodecContext> openDecoder(const AVStream& stream, const std::string& subject) {
  const AVCodec* codec = avcodec_find_decoder(stream.codecpar->codec_id);
  if (codec == nullptr) {
    return tl::unexpected(Error{
        .kind = ErrorKind::kUnsupported,
        .subject = subject,
        .problem = std::string("no decoder for ") + avcodec_get_name(stream.codecpar->codec_id),
        .remedy = "convert it to H.264"});
  }
  auto decoder = libav::owned<libav::CodecContext>(avcodec_alloc_context3(codec));
  const libav::LogCapture log;
  int status = avcodec_parameters_to_context(decoder.get(), stream.codecpar);
  decoder->pkt_timebase = stream.time_base;
  decoder->max_pixels = kMaxPixels;
  decoder->thread_count = 2;
  // The decoder delivers broken frames, too, marked as corrupt, so that they are counted.
  decoder->flags |= AV_CODEC_FLAG_OUTPUT_CORRUPT;
  if (status >= 0) status = avcodec_open2(decoder.get(), codec, nullptr);
  if (status < 0) return tl::unexpected(broken(subject, "is a broken movie", status, log));
  return decoder;
}

std::string tagOf(const AVStream& stream, const char* name) {
  const AVDictionaryEntry* entry = av_dict_get(stream.metadata, name, nullptr, 0);
  return entry == nullptr ? std::string() : std::string(entry->value);
}

/// The track of facts of a captured stream; null in other movies.
AVStream* findFacts(const AVFormatContext& context, const AVStream& video) {
  if (!captures::pixelFormatNamed(tagOf(video, captures::kLayoutTag))) return nullptr;
  for (unsigned i = 0; i < context.nb_streams; ++i) {
    AVStream* const stream = context.streams[i];
    if (stream->codecpar->codec_id == AV_CODEC_ID_SUBRIP) return stream;
  }
  return nullptr;
}

class MovieSource final : public FrameSource {
 public:
  MovieSource(std::string subject, DemuxedFile file, libav::CodecContext decoder,
              const RecordingOptions& options, MovieBounds bounds)
      : subject_(std::move(subject)),
        file_(std::move(file)),
        decoder_(std::move(decoder)),
        bounds_(std::move(bounds)) {
    if (isMp4()) {
      boxes_ = libav::scanMp4(file_.io.file(), static_cast<std::uint32_t>(file_.stream->id));
    }
    limitTo(options);
  }

  std::optional<Duration> framePeriod() const override {
    if (isCapture()) return capturedPeriod();
    const AVRational rate = file_.stream->avg_frame_rate;
    if (rate.num <= 0 || rate.den <= 0) return std::nullopt;
    const Duration period(av_rescale_q(1, av_inv_q(rate), {1, 1'000'000'000}));
    return period > Duration::zero() ? std::optional(period) : std::nullopt;
  }

  std::optional<std::uint64_t> frameCount() const override {
    if (from_ || to_) return std::nullopt;
    std::int64_t count = file_.stream->nb_frames;
    // For Y4M, libav divides the file's size by a frame's, and one frame lasts one unit of the time
    // base.
    if (isY4m()) count = file_.stream->duration;
    const std::uint64_t total =
        (count > 0 ? static_cast<std::uint64_t>(count) : 0) + boxes_.fragmentSamples;
    return total > 0 ? std::optional(total) : std::nullopt;
  }

  std::optional<Duration> length() const override {
    const std::int64_t length = file_.context->duration;
    if (length == AV_NOPTS_VALUE || length <= 0) return std::nullopt;
    return Duration(av_rescale(length, 1'000'000'000, AV_TIME_BASE));
  }

  std::optional<PixelFormat> capturedLayout() const override {
    return isCapture() ? captures::pixelFormatNamed(tag(captures::kLayoutTag)) : std::nullopt;
  }
  std::string capturedFrom() const override { return tag(captures::kCameraTag); }

  SourceItem next() override;

 private:
  bool isCapture() const { return file_.facts != nullptr; }
  std::string tag(const char* name) const { return tagOf(*file_.stream, name); }
  std::optional<Duration> capturedPeriod() const;
  void noteFacts(const AVPacket& packet);
  bool isMp4() const { return isOneOf(file_.context->iformat->name, "mp4"); }
  bool isY4m() const { return isOneOf(file_.context->iformat->name, "yuv4mpegpipe"); }
  bool isMatroska() const { return isOneOf(file_.context->iformat->name, "matroska"); }
  void limitTo(const RecordingOptions& options);
  bool isBefore(const AVFrame& frame, const std::optional<std::int64_t>& time) const {
    return time && frame.best_effort_timestamp != AV_NOPTS_VALUE &&
           frame.best_effort_timestamp < *time;
  }
  void tagWithOrientation(AVFrame& frame) const;
  void leaveOut() {
    ++dropped_;
    waitingForKey_ = true;
  }
  bool isSound(const AVFrame& frame) const;
  SourceFrame deliver(libav::Frame frame);
  void feed();
  void reachEnd(int status, const libav::LogCapture& log);
  std::optional<Error> whyTruncated(const libav::LogCapture& log) const;

  std::string subject_;
  DemuxedFile file_;
  libav::CodecContext decoder_;
  MovieBounds bounds_;
  int packetsWithoutFrame_ = 0;
  libav::Packet packet_ = libav::makePacket();
  libav::Mp4Boxes boxes_;
  // The part to be played, in the stream's time base.
  std::optional<std::int64_t> from_;
  std::optional<std::int64_t> to_;
  bool waitingForKey_ = false;
  bool atEnd_ = false;
  std::uint64_t dropped_ = 0;  ///< since the previous delivered frame
  std::int64_t packetsRead_ = 0;
  std::int64_t lastPacketEnd_ = 0;
  std::optional<Error> truncated_;
  std::map<std::int64_t, captures::FrameFacts> facts_;  ///< of frames to come, by their time
};

std::optional<Duration> MovieSource::capturedPeriod() const {
  const std::string text = tag(captures::kPeriodTag);
  std::int64_t period = 0;
  std::from_chars(text.data(), text.data() + text.size(), period);
  // As RecordingOptions::picturePeriod, between a microsecond and an hour.
  const bool isPlausible = period >= 1000 && period <= 3'600'000'000'000;
  return isPlausible ? std::optional(Duration(period)) : std::nullopt;
}

/// They come before their frame.
void MovieSource::noteFacts(const AVPacket& packet) {
  constexpr std::size_t kMost = 64;  // of damaged files, whose frames are missing
  if (facts_.size() >= kMost) facts_.erase(facts_.begin());
  const std::string_view text(reinterpret_cast<const char*>(packet.data),
                              static_cast<std::size_t>(std::max(packet.size, 0)));
  if (const auto facts = captures::parseFacts(text)) facts_[packet.pts] = *facts;
}

bool MovieSource::isSound(const AVFrame& frame) const {
  const bool broken = (frame.flags & AV_FRAME_FLAG_CORRUPT) != 0 || frame.decode_error_flags != 0;
  // The frames after a broken one are predicted from it, up to the next key frame.
  return !broken && (!waitingForKey_ || frame.key_frame != 0);
}

/// Seeks to the key frame before the part's beginning; the frames between are decoded and dropped.
void MovieSource::limitTo(const RecordingOptions& options) {
  if (options.to) to_ = libav::timeInStream(*file_.stream, *options.to);
  if (options.from <= Duration::zero()) return;
  from_ = libav::timeInStream(*file_.stream, options.from);
  // Where that fails, all frames from the beginning on are decoded.
  av_seek_frame(file_.context.get(), file_.stream->index, *from_, AVSEEK_FLAG_BACKWARD);
}

/// The container's display matrix takes precedence over the codec's.
void MovieSource::tagWithOrientation(AVFrame& frame) const {
  std::size_t bytes = 0;
  const std::uint8_t* matrix =
      av_stream_get_side_data(file_.stream, AV_PKT_DATA_DISPLAYMATRIX, &bytes);
  if (matrix == nullptr) return;
  av_frame_remove_side_data(&frame, AV_FRAME_DATA_DISPLAYMATRIX);
  AVFrameSideData* side = av_frame_new_side_data(&frame, AV_FRAME_DATA_DISPLAYMATRIX, bytes);
  if (side == nullptr) throw std::bad_alloc();
  std::copy_n(matrix, bytes, side->data);
}

SourceFrame MovieSource::deliver(libav::Frame frame) {
  waitingForKey_ = false;
  packetsWithoutFrame_ = 0;
  SourceFrame item{
      .frame = nullptr, .time = std::nullopt, .droppedBefore = std::exchange(dropped_, 0)};
  if (frame->best_effort_timestamp != AV_NOPTS_VALUE) {
    const std::int64_t time =
        av_rescale_q(frame->best_effort_timestamp, file_.stream->time_base, {1, 1'000'000'000});
    item.time = Duration(time);
  }
  if (const auto facts = facts_.find(frame->best_effort_timestamp); facts != facts_.end()) {
    item.facts = facts->second;
    item.time = facts->second.time;
    facts_.erase(facts_.begin(), std::next(facts));
  }
  tagWithOrientation(*frame);
  frame->sample_aspect_ratio =
      av_guess_sample_aspect_ratio(file_.context.get(), file_.stream, frame.get());
  item.frame = std::shared_ptr<const AVFrame>(std::move(frame));
  return item;
}

SourceItem MovieSource::next() {
  for (;;) {
    libav::Frame frame = libav::makeFrame();
    const int status = avcodec_receive_frame(decoder_.get(), frame.get());
    if (status == AVERROR_EOF) break;
    if (status == AVERROR(EAGAIN)) {
      if (bounds_.isUnwanted && bounds_.isUnwanted()) return SourceEnd{};
      if (bounds_.mostWithoutFrame && packetsWithoutFrame_ > *bounds_.mostWithoutFrame) break;
      feed();
    } else if (status < 0 || !isSound(*frame)) {
      leaveOut();
    } else if (const FrameSize size{frame->width, frame->height}; !isAcceptedSize(size)) {
      return libav::tooLarge(subject_, size);
    } else if (isBefore(*frame, from_)) {
      dropped_ = 0;
      packetsWithoutFrame_ = 0;
      waitingForKey_ = false;
    } else if (to_ && frame->best_effort_timestamp != AV_NOPTS_VALUE && !isBefore(*frame, to_)) {
      return SourceEnd{};
    } else {
      return deliver(std::move(frame));
    }
  }
  if (!truncated_ && dropped_ > 0) {
    truncated_ = aborted(subject_, "its last " + std::to_string(dropped_) + " frames are broken");
  }
  return SourceEnd{.truncated = truncated_};
}

/// Feeds the decoder one packet from the file, or the end of the stream.
void MovieSource::feed() {
  if (atEnd_) {
    // A decoder that keeps asking for input after the end would loop for ever.
    avcodec_flush_buffers(decoder_.get());
    avcodec_send_packet(decoder_.get(), nullptr);
    return;
  }
  const libav::LogCapture log;
  const int status = av_read_frame(file_.context.get(), packet_.get());
  if (status < 0) return reachEnd(status, log);
  if (isCapture() && packet_->stream_index == file_.facts->index) noteFacts(*packet_);
  if (packet_->stream_index == file_.stream->index) {
    ++packetsRead_;
    ++packetsWithoutFrame_;
    lastPacketEnd_ = packet_->pos + packet_->size;
    const bool cut = (packet_->flags & AV_PKT_FLAG_CORRUPT) != 0;
    if (cut || avcodec_send_packet(decoder_.get(), packet_.get()) < 0) leaveOut();
  }
  av_packet_unref(packet_.get());
}

void MovieSource::reachEnd(int status, const libav::LogCapture& log) {
  atEnd_ = true;
  truncated_ = status == AVERROR_EOF
                   ? whyTruncated(log)
                   : std::optional(broken(subject_, "cannot be read to its end", status, log));
  avcodec_send_packet(decoder_.get(), nullptr);
}

std::optional<Error> MovieSource::whyTruncated(const libav::LogCapture& log) const {
  bool cut = false;
  if (isMp4()) {
    // Edit lists skip samples on purpose. If libav reported errors in the index, they count as
    // lost.
    const bool isWhole = !from_;
    const bool indexIsShort =
        isWhole && packetsRead_ < avformat_index_get_entries_count(file_.stream);
    const bool samplesAreLost =
        isWhole && !file_.complaint.empty() && packetsRead_ < file_.stream->nb_frames;
    cut = indexIsShort || samplesAreLost || (boxes_.fragmentSamples > 0 && boxes_.aborted);
  } else if (isY4m()) {
    // libav reports no error if the last frame is too short.
    cut = !file_.io.file().isStream() && lastPacketEnd_ != file_.io.file().sizeBytes();
  } else if (isMatroska() && !file_.io.file().isStream() &&
             libav::segmentBreaksOff(file_.io.file())) {
    cut = true;
  } else if (!log.firstError().empty()) {
    return aborted(subject_, "is truncated: " + log.firstError());
  }
  if (!cut) return std::nullopt;
  return aborted(subject_, "is truncated");
}

}  // namespace

Result<std::unique_ptr<FrameSource>> openMovie(const std::filesystem::path& path,
                                               const RecordingOptions& options,
                                               MovieBounds bounds) {
  libav::redirectLog();
  const bool isStandardInput = path == kStandardInput;
  const std::string subject = isStandardInput ? "standard input" : path.string();
  Result<FileInput> input = isStandardInput ? FileInput::standardInput() : FileInput::open(path);
  if (!input) return tl::unexpected(input.error());
  DemuxedFile file{.io = libav::DemuxerIo(*std::move(input)), .context = nullptr, .complaint = {}};
  if (Result<void> opened = openContainer(file, subject); !opened) {
    return tl::unexpected(opened.error());
  }
  if (Result<void> checked = checkSizes(file, subject); !checked) {
    return tl::unexpected(checked.error());
  }
  if (Result<void> found = findStreams(file, subject); !found) {
    return tl::unexpected(found.error());
  }
  const int index = av_find_best_stream(file.context.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0 || (file.context->streams[index]->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0) {
    return tl::unexpected(broken(subject, "holds no video"));
  }
  file.stream = file.context->streams[index];
  file.facts = findFacts(*file.context, *file.stream);
  for (unsigned i = 0; i < file.context->nb_streams; ++i) {
    AVStream* const stream = file.context->streams[i];
    if (stream != file.stream && stream != file.facts) stream->discard = AVDISCARD_ALL;
  }
  Result<libav::CodecContext> decoder = openDecoder(*file.stream, subject);
  if (!decoder) return tl::unexpected(decoder.error());
  return std::make_unique<MovieSource>(subject, std::move(file), *std::move(decoder), options,
                                       std::move(bounds));
}

}  // namespace pleinair::hal::recording
