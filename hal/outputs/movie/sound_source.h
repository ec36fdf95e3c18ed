#pragma once

#include "hal/clock.h"
#include "hal/media/handles.h"

namespace pleinair::hal::movie {

/// The coded sound of a painting, packet by packet. One thread.
class SoundSource {
 public:
  virtual ~SoundSource() = default;
  /// How the stream is coded; its codec's name is avcodec_get_name().
  virtual const AVCodecParameters& coding() const = 0;
  virtual AVRational timeBase() const = 0;
  /// The next packet that begins before `end`, with its times on the painting's time, in
  /// timeBase(); null at the end of the sound, or where the next one begins later. Packets from
  /// before 0 are left out. Valid until the next call.
  virtual AVPacket* nextBefore(Duration end) = 0;
  /// Whether there is none any more, as far as nextBefore() has found out.
  virtual bool hasEnded() const = 0;
};

}  // namespace pleinair::hal::movie
