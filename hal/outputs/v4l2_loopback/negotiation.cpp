#include "hal/outputs/v4l2_loopback/negotiation.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "hal/v4l2/formats.h"

namespace pleinair::hal::loopback {

std::optional<FrameLayout> FrameLayout::of(const FrameFormat& format, std::size_t strideBytes) {
  FrameLayout layout{.format = format};
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    const std::size_t row = rowBytes(format.pixelFormat, plane, format.size.width);
    const bool isHalf = format.pixelFormat == PixelFormat::kI420 && plane > 0;
    const std::size_t stride = strideBytes == 0 ? row : strideBytes / (isHalf ? 2 : 1);
    if (stride < row) return std::nullopt;
    layout.offsetBytes[i] = layout.bytes;
    layout.strideBytes[i] = stride;
    layout.bytes +=
        stride * static_cast<std::size_t>(planeRows(format.pixelFormat, plane, format.size.height));
  }
  return layout;
}

void FrameLayout::pack(const ImageView& picture, std::span<std::uint8_t> frame) const {
  assert(picture.format == format && picture.isComplete() && frame.size() >= bytes);
  for (int plane = 0; plane < planeCount(format.pixelFormat); ++plane) {
    const auto i = static_cast<std::size_t>(plane);
    for (int y = 0; y < planeRows(format.pixelFormat, plane, format.size.height); ++y) {
      const std::size_t begin = offsetBytes[i] + strideBytes[i] * static_cast<std::size_t>(y);
      std::ranges::copy(picture.row(plane, y), frame.subspan(begin).begin());
    }
  }
}

namespace {

struct NamedLayout {
  PixelFormat layout;
  __u32 fourcc;
};
constexpr std::array<NamedLayout, 3> kLayouts{{{PixelFormat::kYuyv, V4L2_PIX_FMT_YUYV},
                                               {PixelFormat::kNv12, V4L2_PIX_FMT_NV12},
                                               {PixelFormat::kI420, V4L2_PIX_FMT_YUV420}}};

std::optional<PixelFormat> layoutOf(__u32 fourcc) {
  const auto* const found = std::ranges::find(kLayouts, fourcc, &NamedLayout::fourcc);
  return found == kLayouts.end() ? std::nullopt : std::optional(found->layout);
}

int roundedToEven(int side) {
  return side + side % 2;
}

/// sRGB's colours as cameras of desktops deliver them, which readers take for granted whatever the
/// device tells them.
constexpr ColorEncoding kWanted{.matrix = ColorMatrix::kBt601, .range = ColorRange::kLimited};

v4l2_format wanted(PixelFormat layout, __u32 fourcc, FrameSize size) {
  const FrameSize even{roundedToEven(size.width), roundedToEven(size.height)};
  const auto packed =
      *FrameLayout::of({.pixelFormat = layout, .size = even, .encoding = kWanted}, 0);
  v4l2_format format{};
  format.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  v4l2_pix_format& pix = format.fmt.pix;
  pix.width = static_cast<__u32>(even.width);
  pix.height = static_cast<__u32>(even.height);
  pix.pixelformat = fourcc;
  pix.field = V4L2_FIELD_NONE;
  pix.bytesperline = static_cast<__u32>(packed.strideBytes[0]);
  pix.sizeimage = static_cast<__u32>(packed.bytes);
  pix.colorspace = V4L2_COLORSPACE_SRGB;
  pix.priv = V4L2_PIX_FMT_PRIV_MAGIC;  // what follows counts
  pix.ycbcr_enc = V4L2_YCBCR_ENC_601;
  pix.quantization = V4L2_QUANTIZATION_LIM_RANGE;
  pix.xfer_func = V4L2_XFER_FUNC_SRGB;
  return format;
}

Error held(const std::string& subject, const std::string& by) {
  return {.kind = ErrorKind::kBusy,
          .subject = subject,
          .problem = "keeps its format" + by,
          .remedy = "close the programs that have it open (fuser -v " + subject +
                    "), or let it go: v4l2-ctl -d " + subject + " -c keep_format=0"};
}

Error refused(const std::string& subject, const std::string& answered) {
  return {.kind = ErrorKind::kUnsupported,
          .subject = subject,
          .problem = "takes none of the layouts that can be written" +
                     (answered.empty() ? "" : " (it answers " + answered + ")"),
          .remedy = "YUYV, NV12 or I420 must be among `v4l2-ctl -d " + subject +
                    " --list-formats-out`; another format in [output.loopback] may do"};
}

Error failed(const std::string& subject, int errnoValue) {
  if (errnoValue == EBUSY) return held(subject, "");
  Error error = errnoError(subject, "cannot set the format", errnoValue);
  if (errnoValue == ENODEV || errnoValue == ENXIO) error.kind = ErrorKind::kDeviceLost;
  return error;
}

/// The layouts to try, those first that the device lists.
std::vector<NamedLayout> candidates(v4l2::SystemCalls& calls, int fd,
                                    std::optional<PixelFormat> layout) {
  std::vector<NamedLayout> result;
  for (const NamedLayout& each : kLayouts) {
    if (!layout || each.layout == *layout) result.push_back(each);
  }
  constexpr __u32 kMaxListed = 256;  // a driver that never ends its list
  std::vector<__u32> listed;
  for (__u32 i = 0; i < kMaxListed; ++i) {
    v4l2_fmtdesc entry{};
    entry.index = i;
    entry.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    if (calls.ioctl(fd, VIDIOC_ENUM_FMT, &entry) < 0) break;
    listed.push_back(entry.pixelformat);
  }
  // std::ranges' would not compile with clang 14
  std::stable_partition(result.begin(), result.end(), [&](const NamedLayout& each) {
    return std::ranges::find(listed, each.fourcc) != listed.end();
  });
  return result;
}

/// The size of one frame's bytes. v4l2loopback answers VIDIOC_S_FMT with the size of its buffers,
/// whole pages, and readers that find so many bytes in a frame take it for broken; VIDIOC_G_FMT
/// tells the frame's.
std::size_t frameBytesOf(v4l2::SystemCalls& calls, int fd, const v4l2_pix_format& answer) {
  v4l2_format now{};
  now.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  const bool isAnswered = calls.ioctl(fd, VIDIOC_G_FMT, &now) >= 0 &&
                          now.fmt.pix.pixelformat == answer.pixelformat &&
                          now.fmt.pix.width == answer.width && now.fmt.pix.height == answer.height;
  return isAnswered ? now.fmt.pix.sizeimage : answer.sizeimage;
}

Result<Agreement> agreed(v4l2::SystemCalls& calls, int fd, const std::string& subject,
                         PixelFormat pixelFormat, const v4l2_pix_format& answer) {
  const FrameSize size{static_cast<int>(answer.width), static_cast<int>(answer.height)};
  const std::string sizeText = std::to_string(answer.width) + "x" + std::to_string(answer.height);
  if (!isAcceptedSize(size) || size.width % 2 != 0 || size.height % 2 != 0) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = "wants pictures of " + sizeText,
                                .remedy = "close what holds it at that size; even sides of at most "
                                          "8192 px can be written"});
  }
  const auto layout = FrameLayout::of(
      {.pixelFormat = pixelFormat,
       .size = size,
       .encoding = v4l2::colorEncodingOf(answer.colorspace, answer.ycbcr_enc, answer.quantization)},
      answer.bytesperline);
  const std::size_t frameBytes = frameBytesOf(calls, fd, answer);
  if (!layout || frameBytes < layout->bytes) {
    return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                .subject = subject,
                                .problem = "answers " + sizeText + " with a stride of " +
                                           std::to_string(answer.bytesperline) + " and " +
                                           std::to_string(frameBytes) +
                                           " bytes a frame, which do not fit together"});
  }
  return Agreement{.layout = *layout, .frameBytes = frameBytes};
}

}  // namespace

Result<Agreement> negotiate(v4l2::SystemCalls& calls, int fd, const std::string& subject,
                            const OutputRequest& request, std::optional<PixelFormat> layout) {
  std::string answered;
  for (const NamedLayout& candidate : candidates(calls, fd, layout)) {
    v4l2_format format = wanted(candidate.layout, candidate.fourcc, request.size);
    const int result = calls.ioctl(fd, VIDIOC_S_FMT, &format);
    if (result == -EINVAL) continue;
    if (result < 0) return tl::unexpected(failed(subject, -result));
    const auto given = layoutOf(format.fmt.pix.pixelformat);
    if (given && (!layout || *given == *layout)) {
      return agreed(calls, fd, subject, *given, format.fmt.pix);
    }
    answered = v4l2::fourccText(format.fmt.pix.pixelformat);
    if (given) return tl::unexpected(held(subject, " " + answered));
  }
  return tl::unexpected(refused(subject, answered));
}

void announceRate(v4l2::SystemCalls& calls, int fd, Duration framePeriod) {
  v4l2_streamparm parameters{};
  parameters.type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
  parameters.parm.output.timeperframe = fractionOf(framePeriod);
  calls.ioctl(fd, VIDIOC_S_PARM, &parameters);  // many devices have none
}

v4l2_fract fractionOf(Duration period) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t nanoseconds = std::clamp<std::int64_t>(period.count(), 1, 4 * kSecond);
  const double rate = static_cast<double>(kSecond) / static_cast<double>(nanoseconds);
  struct Family {
    double numerator, step;  ///< whole rates, and those of television: 30000/1001
  };
  for (const Family& family : {Family{1, 1}, Family{1001, 1000}}) {
    const double denominator = std::round(rate * family.numerator / family.step) * family.step;
    constexpr double kShare = 1e-6;  // a period in nanoseconds is as exact up to 1000 a second
    if (denominator >= 1 && std::abs(denominator / family.numerator / rate - 1) < kShare) {
      return {.numerator = static_cast<__u32>(family.numerator),
              .denominator = static_cast<__u32>(denominator)};
    }
  }
  const std::int64_t common = std::gcd(nanoseconds, kSecond);
  return {.numerator = static_cast<__u32>(nanoseconds / common),
          .denominator = static_cast<__u32>(kSecond / common)};
}

}  // namespace pleinair::hal::loopback
