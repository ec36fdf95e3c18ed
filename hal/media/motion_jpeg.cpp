#include "hal/media/motion_jpeg.h"

#include <algorithm>
#include <memory>
#include <optional>

#include "hal/media/picture_decoder.h"
#include "hal/media/picture_header.h"

namespace pleinair::hal::libav {
namespace {

constexpr ColorEncoding kJfif{.matrix = ColorMatrix::kBt601, .range = ColorRange::kFull};

/// How many chroma samples cover two by two pixels: 2 by 2 in 4:4:4, 1 by 2 in 4:2:2. Nothing for
/// other layouts than 8-bit planar Y'CbCr.
struct ChromaDensity {
  int across = 0;  ///< 0: half a sample
  int down = 0;
};
std::optional<ChromaDensity> chromaDensity(int format) {
  switch (format) {
    case AV_PIX_FMT_YUV420P:
    case AV_PIX_FMT_YUVJ420P:
      return ChromaDensity{1, 1};
    case AV_PIX_FMT_YUV422P:
    case AV_PIX_FMT_YUVJ422P:
      return ChromaDensity{1, 2};
    case AV_PIX_FMT_YUV440P:
    case AV_PIX_FMT_YUVJ440P:
      return ChromaDensity{2, 1};
    case AV_PIX_FMT_YUV444P:
    case AV_PIX_FMT_YUVJ444P:
      return ChromaDensity{2, 2};
    case AV_PIX_FMT_YUV411P:
    case AV_PIX_FMT_YUVJ411P:
      return ChromaDensity{0, 2};
    default:
      return std::nullopt;
  }
}

const std::uint8_t* rowOf(const AVFrame& frame, int plane, int y) {
  return frame.data[plane] + std::ptrdiff_t{y} * frame.linesize[plane];
}

void copyLuma(const AVFrame& from, Image& to) {
  for (int y = 0; y < from.height; ++y) {
    std::copy_n(rowOf(from, 0, y), from.width, to.row(0, y).begin());
  }
}

/// Averages the samples that a pixel of 4:2:0 chroma covers, rounded.
void averageChroma(const AVFrame& from, ChromaDensity density, int plane, Image& to) {
  const int sourceRows =
      density.down == 2 ? from.height : planeRows(PixelFormat::kI420, plane, from.height);
  const int sourceColumns = density.across == 2 ? from.width : (from.width + 1) / 2;
  const int rows = planeRows(PixelFormat::kI420, plane, from.height);
  for (int y = 0; y < rows; ++y) {
    const int first = std::min(y * density.down, sourceRows - 1);
    const int last = std::min(first + density.down - 1, sourceRows - 1);
    const std::uint8_t* upper = rowOf(from, plane, first);
    const std::uint8_t* lower = rowOf(from, plane, last);
    const auto row = to.row(plane, y);
    for (std::size_t x = 0; x < row.size(); ++x) {
      std::size_t left = x;
      std::size_t right = x;
      if (density.across == 2) {
        left = 2 * x;
        right = std::min(left + 1, static_cast<std::size_t>(sourceColumns - 1));
      } else if (density.across == 0) {
        left = right = x / 2;
      }
      row[x] = static_cast<std::uint8_t>(
          (upper[left] + upper[right] + lower[left] + lower[right] + 2) / 4);
    }
  }
}

LentPicture lendWithoutCopy(const std::shared_ptr<const AVFrame>& frame, FrameFormat format) {
  LentPicture lent{.view = {.format = format, .planes = {}}, .lease = frame};
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const auto stride = static_cast<std::size_t>(frame->linesize[plane]);
    const auto rows =
        static_cast<std::size_t>(planeRows(format.pixelFormat, plane, format.size.height));
    const std::size_t packed = rowBytes(format.pixelFormat, plane, format.size.width);
    lent.view.planes.at(static_cast<std::size_t>(plane)) = {
        .bytes = {frame->data[plane], stride * (rows - 1) + packed}, .strideBytes = stride};
  }
  return lent;
}

}  // namespace

Result<LentPicture> decodeMotionJpeg(std::span<const std::uint8_t> bytes,
                                     const std::string& subject) {
  if (pictureKindOf(bytes) != PictureKind::kJpeg) {
    return tl::unexpected(
        Error{.kind = ErrorKind::kInvalidInput, .subject = subject, .problem = "gives no JPEG"});
  }
  const Result<std::shared_ptr<const AVFrame>> decoded = decodePicture(bytes, subject);
  if (!decoded) return tl::unexpected(decoded.error());
  const AVFrame& frame = **decoded;
  const FrameFormat format{
      .pixelFormat = PixelFormat::kI420, .size = {frame.width, frame.height}, .encoding = kJfif};
  const std::optional<ChromaDensity> density = chromaDensity(frame.format);
  if (!density && frame.format != AV_PIX_FMT_GRAY8) {
    const char* name = av_get_pix_fmt_name(static_cast<AVPixelFormat>(frame.format));
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = std::string("gives JPEGs of the layout ") +
                                           (name != nullptr ? name : "unknown")});
  }
  if (density && density->across == 1 && density->down == 1 && frame.linesize[0] > 0) {
    return lendWithoutCopy(*decoded, format);
  }
  const auto image = std::make_shared<Image>(format);
  copyLuma(frame, *image);
  for (const int plane : {1, 2}) {
    if (density) {
      averageChroma(frame, *density, plane, *image);
    } else {
      std::ranges::fill(image->plane(plane), std::uint8_t{128});
    }
  }
  return LentPicture{.view = image->view(), .lease = image};
}

}  // namespace pleinair::hal::libav
