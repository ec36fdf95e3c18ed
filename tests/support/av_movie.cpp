#include "tests/support/av_movie.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <string>

namespace pleinair::support {
namespace {

using namespace hal::libav;

constexpr int kSampleRate = 48'000;

int checked(int status, const char* what) {
  if (status >= 0) return status;
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(status, text, sizeof text);
  throw std::runtime_error(std::string(what) + ": " + text);
}

/// An encoder whose packets go to one stream of a muxer.
class Track {
 public:
  Track(AVFormatContext& muxer, CodecContext encoder)
      : muxer_(muxer), encoder_(std::move(encoder)), stream_(avformat_new_stream(&muxer, nullptr)) {
    if ((muxer.oformat->flags & AVFMT_GLOBALHEADER) != 0) {
      encoder_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    }
    checked(avcodec_open2(encoder_.get(), encoder_->codec, nullptr), "open encoder");
    checked(avcodec_parameters_from_context(stream_->codecpar, encoder_.get()), "parameters");
    stream_->time_base = encoder_->time_base;
    stream_->sample_aspect_ratio = encoder_->sample_aspect_ratio;
    stream_->avg_frame_rate = encoder_->framerate;
  }

  AVCodecContext& encoder() { return *encoder_; }

  /// Null ends the stream.
  void send(const AVFrame* frame) {
    checked(avcodec_send_frame(encoder_.get(), frame), "encode");
    const Packet packet = makePacket();
    while (avcodec_receive_packet(encoder_.get(), packet.get()) >= 0) {
      av_packet_rescale_ts(packet.get(), encoder_->time_base, stream_->time_base);
      packet->stream_index = stream_->index;
      checked(av_interleaved_write_frame(&muxer_, packet.get()), "write");
    }
  }

 private:
  AVFormatContext& muxer_;
  CodecContext encoder_;
  AVStream* stream_;
};

CodecContext encoderOf(AVCodecID coding) {
  const AVCodec* codec = avcodec_find_encoder(coding);
  if (codec == nullptr) throw std::runtime_error("no encoder");
  return owned<CodecContext>(avcodec_alloc_context3(codec));
}

CodecContext videoEncoder(const AvMovie& movie) {
  CodecContext encoder = encoderOf(movie.coding);
  encoder->width = movie.size.width;
  encoder->height = movie.size.height;
  encoder->pix_fmt = movie.layout;
  encoder->time_base = {1, movie.framesPerSecond};
  encoder->framerate = {movie.framesPerSecond, 1};
  encoder->sample_aspect_ratio = movie.pixelAspect;
  encoder->color_primaries = movie.primaries;
  encoder->color_trc = movie.transfer;
  encoder->colorspace = movie.matrix;
  encoder->color_range = AVCOL_RANGE_MPEG;
  encoder->gop_size = movie.framesPerSecond;
  return encoder;
}

CodecContext soundEncoder(AVCodecID coding) {
  CodecContext encoder = encoderOf(coding);
  encoder->sample_rate = kSampleRate;
  encoder->sample_fmt = encoder->codec->sample_fmts[0];
  encoder->time_base = {1, kSampleRate};
  encoder->bit_rate = 128'000;
  av_channel_layout_default(&encoder->ch_layout, 1);
  return encoder;
}

void drawGrey(AVFrame& frame, int number) {
  const int depth = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format))->comp[0].depth;
  for (int plane = 0; plane < 3; ++plane) {
    const int rows = plane == 0 ? frame.height : (frame.height + 1) / 2;
    const int value = plane == 0 ? 40 + 4 * number % 160 : 128;
    for (int y = 0; y < rows; ++y) {
      std::uint8_t* row = frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
      const int columns = plane == 0 ? frame.width : (frame.width + 1) / 2;
      if (depth == 8) {
        std::memset(row, value, static_cast<std::size_t>(columns));
      } else {
        std::fill_n(reinterpret_cast<std::uint16_t*>(row), columns,
                    static_cast<std::uint16_t>(value << (depth - 8)));
      }
    }
  }
}

Frame soundFrame(const AVCodecContext& encoder, std::int64_t first, int count,
                 const std::vector<double>& clicks) {
  Frame frame = makeFrame();
  frame->format = encoder.sample_fmt;
  frame->nb_samples = count;
  frame->sample_rate = kSampleRate;
  frame->pts = first;
  av_channel_layout_copy(&frame->ch_layout, &encoder.ch_layout);
  checked(av_frame_get_buffer(frame.get(), 0), "sound frame");
  const bool isFloat = encoder.sample_fmt == AV_SAMPLE_FMT_FLTP;
  for (int i = 0; i < count; ++i) {
    const double time = static_cast<double>(first + i) / kSampleRate;
    // Two milliseconds at a third of the sample rate survive any coding.
    const bool isClick = std::ranges::any_of(
        clicks, [&](double click) { return time >= click && time < click + 0.002; });
    const double value = isClick ? 0.9 * std::sin(2.0 * 3.14159265 * 4000.0 * time) : 0.0;
    if (isFloat) {
      reinterpret_cast<float*>(frame->data[0])[i] = static_cast<float>(value);
    } else {
      reinterpret_cast<std::int16_t*>(frame->data[0])[i] =
          static_cast<std::int16_t>(std::lround(32767.0 * value));
    }
  }
  return frame;
}

}  // namespace

void writeAvMovie(const std::filesystem::path& path, const AvMovie& movie) {
  AVFormatContext* raw = nullptr;
  checked(avformat_alloc_output_context2(&raw, nullptr, nullptr, path.c_str()), "muxer");
  const OutputContext muxer(raw);
  checked(avio_open(&muxer->pb, path.c_str(), AVIO_FLAG_WRITE), "open");
  Track video(*muxer, videoEncoder(movie));
  std::optional<Track> sound;
  if (movie.soundCoding != AV_CODEC_ID_NONE) sound.emplace(*muxer, soundEncoder(movie.soundCoding));
  checked(avformat_write_header(muxer.get(), nullptr), "header");
  std::int64_t samples = 0;
  for (int i = 0; i < movie.frames; ++i) {
    Frame frame = makeFrame();
    frame->format = movie.layout;
    frame->width = movie.size.width;
    frame->height = movie.size.height;
    frame->pts = i;
    checked(av_frame_get_buffer(frame.get(), 0), "frame");
    (movie.draw ? movie.draw : drawGrey)(*frame, i);
    video.send(frame.get());
    const std::int64_t until = std::int64_t{i + 1} * kSampleRate / movie.framesPerSecond;
    while (sound && samples < until) {
      const int count = sound->encoder().frame_size > 0 ? sound->encoder().frame_size : 960;
      sound->send(soundFrame(sound->encoder(), samples, count, movie.clicksSeconds).get());
      samples += count;
    }
  }
  video.send(nullptr);
  if (sound) sound->send(nullptr);
  checked(av_write_trailer(muxer.get()), "trailer");
  avio_closep(&muxer->pb);
}

std::optional<std::vector<double>> clicksIn(const std::filesystem::path& path) {
  AVFormatContext* raw = nullptr;
  checked(avformat_open_input(&raw, path.c_str(), nullptr, nullptr), "open");
  const InputContext input(raw);
  checked(avformat_find_stream_info(input.get(), nullptr), "streams");
  const int video = av_find_best_stream(input.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  const int index = av_find_best_stream(input.get(), AVMEDIA_TYPE_AUDIO, -1, -1, nullptr, 0);
  if (index < 0) return std::nullopt;
  const AVStream& stream = *input->streams[index];
  const AVStream& shown = *input->streams[video];
  const double origin = static_cast<double>(shown.start_time) * av_q2d(shown.time_base);
  const AVCodec* codec = avcodec_find_decoder(stream.codecpar->codec_id);
  const auto decoder = owned<CodecContext>(avcodec_alloc_context3(codec));
  checked(avcodec_parameters_to_context(decoder.get(), stream.codecpar), "parameters");
  decoder->pkt_timebase = stream.time_base;
  checked(avcodec_open2(decoder.get(), codec, nullptr), "decoder");
  std::vector<double> clicks;
  const Packet packet = makePacket();
  const Frame frame = makeFrame();
  while (av_read_frame(input.get(), packet.get()) >= 0) {
    if (packet->stream_index == index) avcodec_send_packet(decoder.get(), packet.get());
    av_packet_unref(packet.get());
    while (avcodec_receive_frame(decoder.get(), frame.get()) >= 0) {
      const double start = static_cast<double>(frame->pts) * av_q2d(stream.time_base) - origin;
      const bool isFloat = frame->format == AV_SAMPLE_FMT_FLTP;
      for (int i = 0; i < frame->nb_samples; ++i) {
        const double value =
            isFloat ? reinterpret_cast<const float*>(frame->data[0])[i]
                    : reinterpret_cast<const std::int16_t*>(frame->data[0])[i] / 32767.0;
        const double time = start + static_cast<double>(i) / kSampleRate;
        const bool isNew = clicks.empty() || time > clicks.back() + 0.1;
        if (std::abs(value) > 0.3 && isNew) clicks.push_back(time);
      }
    }
  }
  return clicks;
}

}  // namespace pleinair::support
