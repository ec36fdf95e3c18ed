#include "hal/media/wide_colour.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <zimg.h>

extern "C" {
#include <libavutil/mastering_display_metadata.h>
}

#include "hal/media/errors.h"
#include "hal/media/tone_curve.h"

namespace pleinair::hal::libav {
namespace {

/// Alignment of planes and of the scratch memory that zimg needs on every processor.
constexpr std::size_t kZimgAlignment = 64;
constexpr double kUnknownPeakNits = 1000.0;

const AVPixFmtDescriptor* layoutOf(const AVFrame& frame) {
  return av_pix_fmt_desc_get(static_cast<AVPixelFormat>(frame.format));
}

bool isRgb(const AVPixFmtDescriptor& layout) {
  return (layout.flags & AV_PIX_FMT_FLAG_RGB) != 0;
}

bool isHdr(const AVFrame& frame) {
  return frame.color_trc == AVCOL_TRC_SMPTE2084 || frame.color_trc == AVCOL_TRC_ARIB_STD_B67;
}

bool isWideGamut(const AVFrame& frame) {
  return frame.color_primaries == AVCOL_PRI_BT2020 || frame.color_primaries == AVCOL_PRI_SMPTE431 ||
         frame.color_primaries == AVCOL_PRI_SMPTE432;
}

Frame makePicture(AVPixelFormat format, FrameSize size) {
  Frame frame = makeFrame();
  frame->format = format;
  frame->width = size.width;
  frame->height = size.height;
  if (av_frame_get_buffer(frame.get(), static_cast<int>(kZimgAlignment)) < 0)
    throw std::bad_alloc();
  return frame;
}

/// Planar, in this machine's byte order, 8 or 16 bits a sample: what zimg reads.
AVPixelFormat planarLayoutOf(const AVFrame& frame) {
  const AVPixFmtDescriptor& layout = *layoutOf(frame);
  const bool isPlanar = (layout.flags & AV_PIX_FMT_FLAG_PLANAR) != 0 || layout.nb_components == 1;
  // zimg takes no odd sizes with subsampled colour.
  const bool isWhole = frame.width % (1 << layout.log2_chroma_w) == 0 &&
                       frame.height % (1 << layout.log2_chroma_h) == 0;
  const bool isOurs =
      isWhole && isPlanar && (layout.flags & AV_PIX_FMT_FLAG_BE) == 0 &&
      (layout.flags & (AV_PIX_FMT_FLAG_FLOAT | AV_PIX_FMT_FLAG_PAL)) == 0 &&
      layout.comp[0].shift == 0 && layout.comp[0].depth <= 16 &&
      av_pix_fmt_count_planes(static_cast<AVPixelFormat>(frame.format)) == layout.nb_components;
  if (isOurs) return static_cast<AVPixelFormat>(frame.format);
  if (isRgb(layout)) return AV_PIX_FMT_GBRP16LE;
  const bool isSubsampled = isWhole && layout.log2_chroma_w == 1 && layout.log2_chroma_h == 1;
  return isSubsampled ? AV_PIX_FMT_YUV420P16LE : AV_PIX_FMT_YUV444P16LE;
}

bool isAligned(const AVFrame& frame) {
  for (int plane = 0; plane < AV_NUM_DATA_POINTERS && frame.data[plane] != nullptr; ++plane) {
    const bool isOurs = reinterpret_cast<std::uintptr_t>(frame.data[plane]) % kZimgAlignment == 0 &&
                        frame.linesize[plane] > 0 &&
                        static_cast<std::size_t>(frame.linesize[plane]) % kZimgAlignment == 0;
    if (!isOurs) return false;
  }
  return true;
}

/// The frame in a layout and alignment that zimg reads; a reference where it is already.
Frame readable(const AVFrame& frame) {
  const AVPixelFormat layout = planarLayoutOf(frame);
  Frame result = makeFrame();
  if (layout == frame.format && isAligned(frame)) {
    if (av_frame_ref(result.get(), &frame) < 0) throw std::bad_alloc();
    return result;
  }
  result = makePicture(layout, {frame.width, frame.height});
  av_frame_copy_props(result.get(), &frame);
  if (layout == frame.format) {
    av_frame_copy(result.get(), &frame);
    return result;
  }
  const Scaler scaler(sws_getContext(
      frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
      frame.height, layout, SWS_POINT | SWS_ACCURATE_RND, nullptr, nullptr, nullptr));
  if (scaler == nullptr) return nullptr;
  // Matrix and range stay as they are.
  constexpr int kUnity = 1 << 16;
  const int range = frame.color_range == AVCOL_RANGE_JPEG ? 1 : 0;
  const int* const matrix = sws_getCoefficients(SWS_CS_DEFAULT);
  sws_setColorspaceDetails(scaler.get(), matrix, range, matrix, range, 0, kUnity, kUnity);
  sws_scale(scaler.get(), frame.data, frame.linesize, 0, frame.height, result->data,
            result->linesize);
  return result;
}

struct FreeGraph {
  void operator()(zimg_filter_graph* graph) const { zimg_filter_graph_free(graph); }
};

/// zimg's codes are those of ITU-T H.273, as libav's are.
zimg_image_format formatOf(const AVFrame& frame) {
  const AVPixFmtDescriptor& layout = *layoutOf(frame);
  zimg_image_format format;
  zimg_image_format_default(&format, ZIMG_API_VERSION);
  format.width = static_cast<unsigned>(frame.width);
  format.height = static_cast<unsigned>(frame.height);
  const bool isFloat = (layout.flags & AV_PIX_FMT_FLAG_FLOAT) != 0;
  format.depth = static_cast<unsigned>(layout.comp[0].depth);
  format.pixel_type = isFloat            ? ZIMG_PIXEL_FLOAT
                      : format.depth > 8 ? ZIMG_PIXEL_WORD
                                         : ZIMG_PIXEL_BYTE;
  const bool isGrey = layout.nb_components == 1;
  format.color_family = isRgb(layout) ? ZIMG_COLOR_RGB : isGrey ? ZIMG_COLOR_GREY : ZIMG_COLOR_YUV;
  format.subsample_w = layout.log2_chroma_w;
  format.subsample_h = layout.log2_chroma_h;
  const bool isFull = isRgb(layout) || frame.color_range == AVCOL_RANGE_JPEG;
  format.pixel_range = isFull ? ZIMG_RANGE_FULL : ZIMG_RANGE_LIMITED;
  const bool isWide = frame.color_primaries == AVCOL_PRI_BT2020 || isHdr(frame);
  constexpr int kFirstHdLine = 720;
  int matrix = frame.colorspace;
  if (matrix == AVCOL_SPC_UNSPECIFIED || matrix == AVCOL_SPC_RESERVED) {
    matrix = isWide                         ? AVCOL_SPC_BT2020_NCL
             : frame.height >= kFirstHdLine ? AVCOL_SPC_BT709
                                            : AVCOL_SPC_SMPTE170M;
  }
  int primaries = frame.color_primaries;
  if (primaries == AVCOL_PRI_UNSPECIFIED || primaries == AVCOL_PRI_RESERVED ||
      primaries == AVCOL_PRI_RESERVED0) {
    const bool is2020 =
        isHdr(frame) || matrix == AVCOL_SPC_BT2020_NCL || matrix == AVCOL_SPC_BT2020_CL;
    primaries = is2020 ? AVCOL_PRI_BT2020 : AVCOL_PRI_BT709;
  }
  // sRGB's primaries are BT.709's, and other SDR ones were always taken for them.
  if (!isWideGamut(frame) && !isHdr(frame))
    primaries = primaries == AVCOL_PRI_BT2020 ? primaries : AVCOL_PRI_BT709;
  int transfer = frame.color_trc;
  // Other curves of SDR are shown as they are coded, as 8-bit frames are.
  if (!isHdr(frame)) transfer = AVCOL_TRC_BT709;
  format.matrix_coefficients =
      static_cast<zimg_matrix_coefficients_e>(isRgb(layout) ? AVCOL_SPC_RGB : matrix);
  format.transfer_characteristics = static_cast<zimg_transfer_characteristics_e>(transfer);
  format.color_primaries = static_cast<zimg_color_primaries_e>(primaries);
  if (frame.chroma_location > AVCHROMA_LOC_UNSPECIFIED && frame.chroma_location < AVCHROMA_LOC_NB) {
    format.chroma_location = static_cast<zimg_chroma_location_e>(frame.chroma_location - 1);
  }
  return format;
}

/// Planar RGB of BT.709 primaries.
zimg_image_format rgbFormat(FrameSize size, zimg_pixel_type_e type, int transfer) {
  zimg_image_format format;
  zimg_image_format_default(&format, ZIMG_API_VERSION);
  format.width = static_cast<unsigned>(size.width);
  format.height = static_cast<unsigned>(size.height);
  format.pixel_type = type;
  format.depth = type == ZIMG_PIXEL_BYTE ? 8 : 32;
  format.color_family = ZIMG_COLOR_RGB;
  format.pixel_range = ZIMG_RANGE_FULL;
  format.matrix_coefficients = ZIMG_MATRIX_RGB;
  format.color_primaries = ZIMG_PRIMARIES_BT709;
  format.transfer_characteristics = static_cast<zimg_transfer_characteristics_e>(transfer);
  return format;
}

/// libav's plane for each of zimg's, which has R, G, B where libav has G, B, R.
std::array<std::size_t, 3> planesOf(const AVFrame& frame) {
  return isRgb(*layoutOf(frame)) ? std::array<std::size_t, 3>{2, 0, 1}
                                 : std::array<std::size_t, 3>{0, 1, 2};
}

Error notConverted() {
  std::array<char, 256> text{};
  zimg_get_last_error(text.data(), text.size());
  return {.kind = ErrorKind::kUnsupported,
          .problem = std::string("its colours cannot be converted: ") + text.data(),
          .remedy = "convert the recording to 8-bit BT.709"};
}

/// Runs one conversion from `source` into `target`, in the formats given.
Result<void> convert(const AVFrame& source, const zimg_image_format& from, AVFrame& target,
                     const zimg_image_format& to) {
  zimg_graph_builder_params options;
  zimg_graph_builder_params_default(&options, ZIMG_API_VERSION);
  options.resample_filter = ZIMG_RESIZE_BICUBIC;
  options.dither_type = ZIMG_DITHER_ORDERED;
  options.nominal_peak_luminance = kReferenceWhiteNits;
  const std::unique_ptr<zimg_filter_graph, FreeGraph> graph(
      zimg_filter_graph_build(&from, &to, &options));
  std::size_t scratchBytes = 0;
  if (graph == nullptr || zimg_filter_graph_get_tmp_size(graph.get(), &scratchBytes) != 0) {
    return tl::unexpected(notConverted());
  }
  zimg_image_buffer_const input{.version = ZIMG_API_VERSION, .plane = {}};
  zimg_image_buffer output{.version = ZIMG_API_VERSION, .plane = {}};
  const auto sourcePlanes = planesOf(source);
  const auto targetPlanes = planesOf(target);
  for (std::size_t i = 0; i < 3; ++i) {
    if (source.data[sourcePlanes[i]] != nullptr) {
      input.plane[i] = {source.data[sourcePlanes[i]], source.linesize[sourcePlanes[i]],
                        ZIMG_BUFFER_MAX};
    }
    output.plane[i] = {target.data[targetPlanes[i]], target.linesize[targetPlanes[i]],
                       ZIMG_BUFFER_MAX};
  }
  const std::align_val_t alignment{kZimgAlignment};
  const auto release = [](void* memory) {
    ::operator delete (memory, std::align_val_t{kZimgAlignment});
  };
  const std::unique_ptr<void, decltype(release)> scratch(
      ::operator new(std::max<std::size_t>(scratchBytes, 1), alignment), release);
  if (zimg_filter_graph_process(graph.get(), &input, &output, scratch.get(), nullptr, nullptr,
                                nullptr, nullptr) != 0) {
    return tl::unexpected(notConverted());
  }
  return {};
}

/// The film's brightest light, in cd/m².
double peakNits(const AVFrame& frame) {
  constexpr double kMostNits = 10000.0;  // of PQ
  double peak = 0;
  if (const AVFrameSideData* side =
          av_frame_get_side_data(&frame, AV_FRAME_DATA_CONTENT_LIGHT_LEVEL)) {
    peak = reinterpret_cast<const AVContentLightMetadata*>(side->data)->MaxCLL;
  }
  if (peak <= 0) {
    if (const AVFrameSideData* side =
            av_frame_get_side_data(&frame, AV_FRAME_DATA_MASTERING_DISPLAY_METADATA)) {
      const auto& display = *reinterpret_cast<const AVMasteringDisplayMetadata*>(side->data);
      if (display.has_luminance != 0 && display.max_luminance.den != 0) {
        peak = av_q2d(display.max_luminance);
      }
    }
  }
  if (!(peak > 0)) peak = kUnknownPeakNits;
  return std::clamp(peak, kReferenceWhiteNits, kMostNits);
}

void mapTones(AVFrame& linear, double peak) {
  const ToneCurve curve(peak);
  const auto row = [&](int plane, int y) {
    return reinterpret_cast<float*>(linear.data[plane] +
                                    std::ptrdiff_t{y} * linear.linesize[plane]);
  };
  for (int y = 0; y < linear.height; ++y) {
    float* const green = row(0, y);
    float* const blue = row(1, y);
    float* const red = row(2, y);
    for (int x = 0; x < linear.width; ++x) curve.apply(red[x], green[x], blue[x]);
  }
}

Frame packed(const AVFrame& planar) {
  Frame target = makePicture(AV_PIX_FMT_RGB24, {planar.width, planar.height});
  for (int y = 0; y < planar.height; ++y) {
    const auto from = [&](int plane) {
      return planar.data[plane] + std::ptrdiff_t{y} * planar.linesize[plane];
    };
    const std::uint8_t* const green = from(0);
    const std::uint8_t* const blue = from(1);
    const std::uint8_t* const red = from(2);
    std::uint8_t* to = target->data[0] + std::ptrdiff_t{y} * target->linesize[0];
    for (int x = 0; x < planar.width; ++x) {
      *to++ = red[x];
      *to++ = green[x];
      *to++ = blue[x];
    }
  }
  return target;
}

}  // namespace

bool isWideColour(const AVFrame& frame) {
  const AVPixFmtDescriptor* const layout = layoutOf(frame);
  constexpr unsigned kNever = AV_PIX_FMT_FLAG_ALPHA | AV_PIX_FMT_FLAG_PAL |
                              AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER |
                              AV_PIX_FMT_FLAG_BITSTREAM;
  if (layout == nullptr || (layout->flags & kNever) != 0) return false;
  const bool isDeep = layout->nb_components >= 3 && layout->comp[0].depth > 8;
  return isDeep || isHdr(frame) || isWideGamut(frame);
}

Result<Frame> toSrgb(const AVFrame& frame, FrameSize size) {
  const Frame source = readable(frame);
  if (source == nullptr) return tl::unexpected(notConverted());
  const Frame coded = makePicture(AV_PIX_FMT_GBRP, size);
  if (!isHdr(frame)) {
    const auto converted = convert(*source, formatOf(*source), *coded,
                                   rgbFormat(size, ZIMG_PIXEL_BYTE, AVCOL_TRC_BT709));
    if (!converted) return tl::unexpected(converted.error());
    return packed(*coded);
  }
  const Frame linear = makePicture(AV_PIX_FMT_GBRPF32LE, size);
  const zimg_image_format light = rgbFormat(size, ZIMG_PIXEL_FLOAT, AVCOL_TRC_LINEAR);
  if (auto converted = convert(*source, formatOf(*source), *linear, light); !converted) {
    return tl::unexpected(std::move(converted.error()));
  }
  mapTones(*linear, peakNits(frame));
  const auto encoded =
      convert(*linear, light, *coded, rgbFormat(size, ZIMG_PIXEL_BYTE, AVCOL_TRC_IEC61966_2_1));
  if (!encoded) return tl::unexpected(encoded.error());
  return packed(*coded);
}

}  // namespace pleinair::hal::libav
