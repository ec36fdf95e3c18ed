#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/media/demuxer_io.h"
#include "hal/media/file_input.h"
#include "hal/media/handles.h"
#include "hal/outputs/movie/sound_source.h"

namespace pleinair::hal::movie {

/// The sound of a recording, packet by packet as it is stored, on the time of its painting: 0 is
/// the first video frame at or after `from`. One thread.
class SoundTrack final : public SoundSource {
 public:
  /// Nothing where the recording has no sound, or is no movie. Errors: as FileInput::open.
  static Result<std::unique_ptr<SoundTrack>> open(const std::filesystem::path& recording,
                                                  Duration from);

  const AVCodecParameters& coding() const override { return *stream_->codecpar; }
  AVRational timeBase() const override { return stream_->time_base; }
  AVPacket* nextBefore(Duration end) override;
  bool hasEnded() const override { return hasEnded_ && !isPending_; }

 private:
  explicit SoundTrack(libav::DemuxerIo io) : io_(std::move(io)) {}
  bool openStreams();
  void findOrigin(Duration from);
  bool read();

  libav::DemuxerIo io_;
  libav::InputContext context_;
  AVStream* video_ = nullptr;   ///< owned by the context, as the next
  AVStream* stream_ = nullptr;  ///< the sound
  std::int64_t origin_ = 0;     ///< 0 of the painting, in timeBase()
  libav::Packet packet_ = libav::makePacket();
  bool isPending_ = false;  ///< packet_ holds the next packet
  bool hasEnded_ = false;
};

}  // namespace pleinair::hal::movie
