#pragma once

// Owning handles for libav's objects, and libav's C headers in one place. For .cpp files and
// internal headers of the HAL only.

#include <memory>
#include <new>

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/avstring.h>
#include <libavutil/frame.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace pleinair::hal::libav {

struct CloseInput {
  void operator()(AVFormatContext* context) const { avformat_close_input(&context); }
};
struct FreeFormat {
  void operator()(AVFormatContext* context) const { avformat_free_context(context); }
};
struct FreeCodec {
  void operator()(AVCodecContext* context) const { avcodec_free_context(&context); }
};
struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
struct FreePacket {
  void operator()(AVPacket* packet) const { av_packet_free(&packet); }
};
struct FreeScaler {
  void operator()(SwsContext* context) const { sws_freeContext(context); }
};
struct FreeIo {
  void operator()(AVIOContext* context) const {
    // libav may have replaced the buffer since.
    if (context != nullptr) av_freep(&context->buffer);
    avio_context_free(&context);
  }
};
struct FreeDictionary {
  void operator()(AVDictionary* dictionary) const { av_dict_free(&dictionary); }
};

using InputContext = std::unique_ptr<AVFormatContext, CloseInput>;
using OutputContext = std::unique_ptr<AVFormatContext, FreeFormat>;
using CodecContext = std::unique_ptr<AVCodecContext, FreeCodec>;
using Frame = std::unique_ptr<AVFrame, FreeFrame>;
using Packet = std::unique_ptr<AVPacket, FreePacket>;
using Scaler = std::unique_ptr<SwsContext, FreeScaler>;
using IoContext = std::unique_ptr<AVIOContext, FreeIo>;
using Dictionary = std::unique_ptr<AVDictionary, FreeDictionary>;

/// Owns an object that libav allocated; throws std::bad_alloc if the allocation failed.
template <class Handle, class T>
Handle owned(T* pointer) {
  if (pointer == nullptr) throw std::bad_alloc();
  return Handle(pointer);
}
inline Frame makeFrame() {
  return owned<Frame>(av_frame_alloc());
}
inline Packet makePacket() {
  return owned<Packet>(av_packet_alloc());
}

}  // namespace pleinair::hal::libav
