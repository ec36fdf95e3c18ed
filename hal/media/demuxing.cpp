#include "hal/media/demuxing.h"

#include <chrono>
#include <new>
#include <vector>

#include "hal/media/container_scan.h"
#include "hal/pixel_format.h"

namespace pleinair::hal::libav {
namespace {

constexpr unsigned kMostStreams = 64;

int refuseToOpen(AVFormatContext*, AVIOContext**, const char*, int, AVDictionary**) {
  return AVERROR(EPERM);
}

/// Ends the opening of a file in which libav keeps searching for streams.
class OpeningDeadline {
 public:
  static int hasPassed(void* opaque) {
    return std::chrono::steady_clock::now() > static_cast<OpeningDeadline*>(opaque)->until_ ? 1 : 0;
  }

 private:
  std::chrono::steady_clock::time_point until_ =
      std::chrono::steady_clock::now() + std::chrono::seconds(10);
};

}  // namespace

void leaveOutCutHead(DemuxerIo& io, const AVInputFormat& format) {
  if (io.file().isStream() || av_match_name("mp4", format.name) == 0) return;
  const std::int64_t readable = readableMp4Bytes(io.file());
  if (readable < io.file().sizeBytes()) io.endAt(readable);
}

AVFormatContext* makeDemuxer(AVIOContext* io) {
  AVFormatContext* context = avformat_alloc_context();
  if (context == nullptr) throw std::bad_alloc();
  context->pb = io;
  context->io_open = &refuseToOpen;
  context->protocol_whitelist = av_strdup("none");
  context->max_streams = kMostStreams;
  return context;
}

int findStreamInfo(AVFormatContext& context) {
  OpeningDeadline deadline;
  context.interrupt_callback = {&OpeningDeadline::hasPassed, &deadline};
  std::vector<Dictionary> owners(context.nb_streams);
  std::vector<AVDictionary*> options(context.nb_streams);
  for (AVDictionary*& option : options) av_dict_set_int(&option, "max_pixels", kMaxPixels, 0);
  const int status =
      avformat_find_stream_info(&context, options.empty() ? nullptr : options.data());
  for (std::size_t i = 0; i < owners.size(); ++i) owners[i].reset(options[i]);
  context.interrupt_callback = {nullptr, nullptr};
  return status;
}

std::int64_t timeInStream(const AVStream& stream, Duration time) {
  constexpr AVRational kNanoseconds = {1, 1'000'000'000};
  const std::int64_t first = stream.start_time == AV_NOPTS_VALUE ? 0 : stream.start_time;
  // Beyond its range, av_rescale_q gives INT64_MIN.
  const std::int64_t since = av_rescale_q(time.count(), kNanoseconds, stream.time_base);
  return av_sat_add64(first, since == INT64_MIN ? INT64_MAX : since);
}

std::int64_t timeBetween(std::int64_t a, std::int64_t b) {
  return av_sat_sub64(a, b);
}

}  // namespace pleinair::hal::libav
