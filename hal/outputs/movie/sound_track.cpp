#include "hal/outputs/movie/sound_track.h"

#include <utility>

#include "hal/media/demuxing.h"
#include "hal/media/errors.h"

namespace pleinair::hal::movie {
namespace {

constexpr AVRational kSoundClock = {1, 1'000'000'000};

}  // namespace

Result<std::unique_ptr<SoundTrack>> SoundTrack::open(const std::filesystem::path& recording,
                                                     Duration from) {
  libav::redirectLog();
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(recording, ignored)) return nullptr;
  Result<FileInput> file = FileInput::open(recording);
  if (!file) return tl::unexpected(file.error());
  std::unique_ptr<SoundTrack> track(new SoundTrack(libav::DemuxerIo(*std::move(file))));
  if (!track->openStreams()) return nullptr;
  track->findOrigin(from);
  return track;
}

/// False where there is no sound beside a video. What is wrong with the movie otherwise, the
/// recorded camera says.
bool SoundTrack::openStreams() {
  const libav::LogCapture log;
  const AVInputFormat* format = nullptr;
  if (av_probe_input_buffer2(io_.context(), &format, "", nullptr, 0, 0) < 0) return false;
  libav::leaveOutCutHead(io_, *format);
  AVFormatContext* context = libav::makeDemuxer(io_.context());
  if (avformat_open_input(&context, "", format, nullptr) < 0) return false;
  context_.reset(context);
  if (libav::findStreamInfo(*context_) < 0) return false;
  const int video = av_find_best_stream(context_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (video < 0) return false;
  const int sound = av_find_best_stream(context_.get(), AVMEDIA_TYPE_AUDIO, -1, video, nullptr, 0);
  if (sound < 0) return false;
  for (unsigned i = 0; i < context_->nb_streams; ++i) {
    const bool isUsed = static_cast<int>(i) == video || static_cast<int>(i) == sound;
    if (!isUsed) context_->streams[i]->discard = AVDISCARD_ALL;
  }
  video_ = context_->streams[video];
  stream_ = context_->streams[sound];
  return true;
}

/// The painting begins at the first video frame at or after `from`, which is found without
/// decoding: the earliest such time among the packets that are decoded before it could be shown.
void SoundTrack::findOrigin(Duration from) {
  std::int64_t first = libav::timeInStream(*video_, Duration::zero());
  if (from > Duration::zero()) {
    const std::int64_t wanted = libav::timeInStream(*video_, from);
    av_seek_frame(context_.get(), video_->index, wanted, AVSEEK_FLAG_BACKWARD);
    std::optional<std::int64_t> found;
    while (av_read_frame(context_.get(), packet_.get()) >= 0) {
      const bool isVideo = packet_->stream_index == video_->index;
      const std::int64_t time = packet_->pts;
      const std::int64_t decoded = packet_->dts == AV_NOPTS_VALUE ? time : packet_->dts;
      av_packet_unref(packet_.get());
      if (!isVideo || time == AV_NOPTS_VALUE) continue;
      if (time >= wanted && (!found || time < *found)) found = time;
      if (found && decoded >= *found) break;
    }
    first = found.value_or(wanted);
    // Some sound before it, since packets of sound may be stored late.
    av_seek_frame(context_.get(), video_->index, wanted, AVSEEK_FLAG_BACKWARD);
  }
  video_->discard = AVDISCARD_ALL;
  origin_ = av_rescale_q(first, video_->time_base, stream_->time_base);
}

bool SoundTrack::read() {
  while (!hasEnded_) {
    av_packet_unref(packet_.get());
    if (av_read_frame(context_.get(), packet_.get()) < 0) break;
    if (packet_->stream_index != stream_->index || packet_->pts == AV_NOPTS_VALUE) continue;
    packet_->pts = libav::timeBetween(packet_->pts, origin_);
    packet_->dts = packet_->pts;  // sound is stored in the order of its times
    if (packet_->pts >= 0) return true;
  }
  hasEnded_ = true;
  return false;
}

AVPacket* SoundTrack::nextBefore(Duration end) {
  if (!isPending_) isPending_ = read();
  if (!isPending_) return nullptr;
  if (av_compare_ts(packet_->pts, stream_->time_base, end.count(), kSoundClock) >= 0)
    return nullptr;
  isPending_ = false;
  return packet_.get();
}

}  // namespace pleinair::hal::movie
