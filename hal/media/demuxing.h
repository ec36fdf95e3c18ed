#pragma once

#include <cstdint>

#include "hal/clock.h"
#include "hal/media/demuxer_io.h"
#include "hal/media/handles.h"

namespace pleinair::hal::libav {

// Opening of files that may be broken or hostile, for the recorded camera and the sound of movies;
// and arithmetic with their times, which may be anything. One thread.

/// A context that reads from `io` only, opens no other file, and finds 64 streams at most.
/// avformat_open_input() frees it on failure.
AVFormatContext* makeDemuxer(AVIOContext* io);

/// Has libav's MP4 demuxer leave out a last fragment's head that the file's end cuts off: it reads
/// all heads first, and refuses the whole file for a broken one. Before avformat_open_input().
void leaveOutCutHead(DemuxerIo& io, const AVInputFormat& format);

/// As avformat_find_stream_info(), within 10 seconds and the limits of frames' sizes.
int findStreamInfo(AVFormatContext& context);

/// `time` in a stream's time base, rounded to nearest so that a time that ffprobe prints finds its
/// frame, after the stream's first time. Saturates.
std::int64_t timeInStream(const AVStream& stream, Duration time);

/// a − b, saturated.
std::int64_t timeBetween(std::int64_t a, std::int64_t b);

}  // namespace pleinair::hal::libav
