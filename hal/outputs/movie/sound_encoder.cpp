#include "hal/outputs/movie/sound_encoder.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <utility>

extern "C" {
#include <libavutil/audio_fifo.h>
#include <libavutil/channel_layout.h>
#include <libswresample/swresample.h>
}

namespace pleinair::hal::movie {
namespace {

constexpr AVRational kNanosecondsOfSound = {1, 1'000'000'000};
constexpr int kStereo = 2;
constexpr std::int64_t kBitsPerChannel = 96'000;
/// A gap in the sound that is filled with silence; beyond it the sound ends.
constexpr std::int64_t kMostGapSeconds = 3600;

struct FreeResampler {
  void operator()(SwrContext* resampler) const { swr_free(&resampler); }
};
struct FreeFifo {
  void operator()(AVAudioFifo* fifo) const { av_audio_fifo_free(fifo); }
};

/// The nearest rate that AAC has.
int aacRate(const AVCodec& codec, int wanted) {
  const int* const rates = codec.supported_samplerates;
  if (rates == nullptr) return wanted;
  int best = rates[0];
  for (const int* rate = rates; *rate != 0; ++rate) {
    if (std::abs(*rate - wanted) < std::abs(best - wanted)) best = *rate;
  }
  return best;
}

class RecodedSound final : public SoundSource {
 public:
  explicit RecodedSound(std::unique_ptr<SoundSource> sound) : sound_(std::move(sound)) {}

  bool open();
  const AVCodecParameters& coding() const override { return *parameters_; }
  AVRational timeBase() const override { return encoder_->time_base; }
  AVPacket* nextBefore(Duration end) override;
  bool hasEnded() const override { return hasEnded_ && !isPending_; }

 private:
  struct FreeParameters {
    void operator()(AVCodecParameters* parameters) const { avcodec_parameters_free(&parameters); }
  };

  bool openDecoder();
  bool openEncoder();
  bool encodeUpTo(Duration end);
  void decode(const AVPacket* packet);
  void take(AVFrame& frame);
  void append(const std::uint8_t* const* samples, int count);
  void appendSilence(std::int64_t count);
  bool feedEncoder(bool isEnd);

  std::unique_ptr<SoundSource> sound_;
  libav::CodecContext decoder_;
  libav::CodecContext encoder_;
  std::unique_ptr<SwrContext, FreeResampler> resampler_;
  std::unique_ptr<AVAudioFifo, FreeFifo> samples_;  ///< resampled, not yet encoded
  std::unique_ptr<AVCodecParameters, FreeParameters> parameters_;
  libav::Packet packet_ = libav::makePacket();
  std::int64_t taken_ = 0;    ///< samples that went into samples_: the time of the next one
  std::int64_t encoded_ = 0;  ///< samples that went into the encoder
  bool isPending_ = false;    ///< packet_ holds the next one
  bool hasEnded_ = false;
};

bool RecodedSound::openDecoder() {
  const AVCodec* const codec = avcodec_find_decoder(sound_->coding().codec_id);
  if (codec == nullptr) return false;
  decoder_ = libav::owned<libav::CodecContext>(avcodec_alloc_context3(codec));
  if (avcodec_parameters_to_context(decoder_.get(), &sound_->coding()) < 0) return false;
  decoder_->pkt_timebase = sound_->timeBase();
  return avcodec_open2(decoder_.get(), codec, nullptr) >= 0 && decoder_->sample_rate > 0;
}

bool RecodedSound::openEncoder() {
  const AVCodec* const codec = avcodec_find_encoder(AV_CODEC_ID_AAC);
  if (codec == nullptr) return false;
  encoder_ = libav::owned<libav::CodecContext>(avcodec_alloc_context3(codec));
  encoder_->sample_fmt = AV_SAMPLE_FMT_FLTP;
  encoder_->sample_rate = aacRate(*codec, decoder_->sample_rate);
  const int channels = std::clamp(decoder_->ch_layout.nb_channels, 1, kStereo);
  av_channel_layout_default(&encoder_->ch_layout, channels);
  encoder_->bit_rate = kBitsPerChannel * channels;
  encoder_->time_base = {1, encoder_->sample_rate};
  encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER | AV_CODEC_FLAG_BITEXACT;
  encoder_->thread_count = 1;
  return avcodec_open2(encoder_.get(), codec, nullptr) >= 0;
}

bool RecodedSound::open() {
  if (!openDecoder() || !openEncoder()) return false;
  parameters_.reset(avcodec_parameters_alloc());
  if (parameters_ == nullptr) throw std::bad_alloc();
  if (avcodec_parameters_from_context(parameters_.get(), encoder_.get()) < 0) return false;
  samples_.reset(av_audio_fifo_alloc(encoder_->sample_fmt, encoder_->ch_layout.nb_channels,
                                     encoder_->frame_size));
  return samples_ != nullptr;
}

AVPacket* RecodedSound::nextBefore(Duration end) {
  for (;;) {
    if (!isPending_ && !encodeUpTo(end)) return nullptr;
    // What primes the decoder lies before 0.
    if (packet_->pts < 0) {
      isPending_ = false;
      continue;
    }
    if (av_compare_ts(packet_->pts, encoder_->time_base, end.count(), kNanosecondsOfSound) >= 0) {
      return nullptr;
    }
    isPending_ = false;
    return packet_.get();
  }
}

/// Gets the next packet into packet_; false where there is none yet, or none any more.
bool RecodedSound::encodeUpTo(Duration end) {
  for (;;) {
    av_packet_unref(packet_.get());
    const int status = avcodec_receive_packet(encoder_.get(), packet_.get());
    if (status >= 0) return isPending_ = true;
    if (status != AVERROR(EAGAIN)) return false;
    if (feedEncoder(hasEnded_)) continue;
    // The encoder holds samples back, so that it is given some from beyond the end.
    constexpr Duration kAhead = std::chrono::milliseconds(200);
    if (const AVPacket* packet = sound_->nextBefore(end + kAhead)) {
      decode(packet);
    } else if (!hasEnded_ && sound_->hasEnded()) {
      decode(nullptr);
      hasEnded_ = true;
    } else {
      return false;
    }
  }
}

void RecodedSound::decode(const AVPacket* packet) {
  // Packets that are broken leave a gap, which the next one's time fills with silence.
  if (avcodec_send_packet(decoder_.get(), packet) < 0) return;
  const libav::Frame frame = libav::makeFrame();
  while (avcodec_receive_frame(decoder_.get(), frame.get()) >= 0) {
    take(*frame);
    av_frame_unref(frame.get());
  }
}

void RecodedSound::take(AVFrame& frame) {
  if (frame.ch_layout.order == AV_CHANNEL_ORDER_UNSPEC) {
    const int channels = frame.ch_layout.nb_channels;
    av_channel_layout_uninit(&frame.ch_layout);
    av_channel_layout_default(&frame.ch_layout, channels);
  }
  if (resampler_ == nullptr) {
    SwrContext* raw = nullptr;
    swr_alloc_set_opts2(&raw, &encoder_->ch_layout, encoder_->sample_fmt, encoder_->sample_rate,
                        &frame.ch_layout, static_cast<AVSampleFormat>(frame.format),
                        frame.sample_rate, 0, nullptr);
    resampler_.reset(raw);
    if (raw == nullptr || swr_init(raw) < 0) {
      resampler_.reset();
      return;
    }
  }
  if (frame.best_effort_timestamp != AV_NOPTS_VALUE) {
    const std::int64_t due =
        av_rescale_q(frame.best_effort_timestamp, sound_->timeBase(), encoder_->time_base);
    const std::int64_t held = swr_get_delay(resampler_.get(), encoder_->sample_rate);
    // Rounded times differ by a little.
    if (due - taken_ - held > encoder_->sample_rate / 100) appendSilence(due - taken_ - held);
  }
  const int room = swr_get_out_samples(resampler_.get(), frame.nb_samples);
  if (room <= 0) return;
  const libav::Frame out = libav::makeFrame();
  out->format = encoder_->sample_fmt;
  out->nb_samples = room;
  av_channel_layout_copy(&out->ch_layout, &encoder_->ch_layout);
  if (av_frame_get_buffer(out.get(), 0) < 0) throw std::bad_alloc();
  const int count =
      swr_convert(resampler_.get(), out->extended_data, room,
                  const_cast<const std::uint8_t**>(frame.extended_data), frame.nb_samples);
  if (count > 0) append(out->extended_data, count);
}

void RecodedSound::append(const std::uint8_t* const* samples, int count) {
  std::array<void*, kStereo> planes{};
  for (int i = 0; i < encoder_->ch_layout.nb_channels; ++i) {
    planes.at(static_cast<std::size_t>(i)) = const_cast<std::uint8_t*>(samples[i]);
  }
  if (av_audio_fifo_write(samples_.get(), planes.data(), count) < count) throw std::bad_alloc();
  taken_ += count;
}

void RecodedSound::appendSilence(std::int64_t count) {
  if (count > kMostGapSeconds * encoder_->sample_rate) {
    hasEnded_ = true;
    return;
  }
  constexpr int kBlock = 4096;
  const std::array<float, kBlock> silence{};
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(silence.data());
  const std::array<const std::uint8_t*, kStereo> planes{bytes, bytes};
  for (; count > 0; count -= kBlock) {
    append(planes.data(), static_cast<int>(std::min<std::int64_t>(count, kBlock)));
  }
}

/// Gives the encoder a frame; at the end the rest, and then the end. False where there is nothing.
bool RecodedSound::feedEncoder(bool isEnd) {
  const int there = av_audio_fifo_size(samples_.get());
  if (there < encoder_->frame_size && !isEnd) return false;
  if (there == 0) return avcodec_send_frame(encoder_.get(), nullptr) >= 0;
  const int count = std::min(there, encoder_->frame_size);
  const libav::Frame frame = libav::makeFrame();
  frame->format = encoder_->sample_fmt;
  frame->sample_rate = encoder_->sample_rate;
  frame->nb_samples = count;
  av_channel_layout_copy(&frame->ch_layout, &encoder_->ch_layout);
  if (av_frame_get_buffer(frame.get(), 0) < 0) throw std::bad_alloc();
  av_audio_fifo_read(samples_.get(), reinterpret_cast<void**>(frame->extended_data), count);
  frame->pts = encoded_;
  encoded_ += count;
  return avcodec_send_frame(encoder_.get(), frame.get()) >= 0;
}

}  // namespace

std::unique_ptr<SoundSource> recodeSound(std::unique_ptr<SoundSource> sound) {
  auto recoded = std::make_unique<RecodedSound>(std::move(sound));
  if (!recoded->open()) return nullptr;
  return recoded;
}

}  // namespace pleinair::hal::movie
