#include "hal/cameras/v4l2/format.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include <linux/videodev2.h>

#include "hal/cameras/v4l2/modes.h"
#include "hal/v4l2/formats.h"

namespace pleinair::hal::v4l2 {
namespace {

using std::chrono_literals::operator""s;

/// A format of the single- or multi-planar interface.
struct PlainFormat {
  std::uint32_t fourcc = 0;
  std::uint32_t width = 0, height = 0;
  std::uint32_t field = 0;
  std::array<std::size_t, 3> strides{};
  int memoryPlanes = 1;
  std::array<std::size_t, 3> imageBytes{};  ///< of each memory plane
  std::uint32_t colorspace = 0, encoding = 0, quantization = 0, transfer = 0;
};

PlainFormat plain(const v4l2_format& format, bool isMultiPlanar) {
  PlainFormat plain;
  if (!isMultiPlanar) {
    const v4l2_pix_format& pix = format.fmt.pix;
    const bool isExtended = pix.priv == V4L2_PIX_FMT_PRIV_MAGIC;
    plain = {.fourcc = pix.pixelformat,
             .width = pix.width,
             .height = pix.height,
             .field = pix.field,
             .strides = {pix.bytesperline, 0, 0},
             .memoryPlanes = 1,
             .imageBytes = {pix.sizeimage, 0, 0},
             .colorspace = pix.colorspace,
             .encoding = isExtended ? pix.ycbcr_enc : 0,
             .quantization = isExtended ? pix.quantization : 0,
             .transfer = isExtended ? pix.xfer_func : 0};
    return plain;
  }
  const v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
  plain = {.fourcc = pix.pixelformat,
           .width = pix.width,
           .height = pix.height,
           .field = pix.field,
           .memoryPlanes = pix.num_planes,
           .colorspace = pix.colorspace,
           .encoding = pix.ycbcr_enc,
           .quantization = pix.quantization,
           .transfer = pix.xfer_func};
  for (std::size_t i = 0; i < plain.strides.size() && i < pix.num_planes; ++i) {
    plain.strides.at(i) = pix.plane_fmt[i].bytesperline;
    plain.imageBytes.at(i) = pix.plane_fmt[i].sizeimage;
  }
  return plain;
}

v4l2_format requestOf(const Device& device, const ModeChoice& choice) {
  constexpr FrameSize kAnySize{640, 480};  // the driver adjusts it
  const FrameSize size = choice.size.value_or(kAnySize);
  v4l2_format format{};
  format.type = device.bufferType();
  if (device.isMultiPlanar()) {
    v4l2_pix_format_mplane& pix = format.fmt.pix_mp;
    pix.width = static_cast<std::uint32_t>(size.width);
    pix.height = static_cast<std::uint32_t>(size.height);
    pix.pixelformat = choice.layout->fourcc;
    pix.field = V4L2_FIELD_NONE;
    pix.num_planes = static_cast<std::uint8_t>(choice.layout->memoryPlanes);
  } else {
    v4l2_pix_format& pix = format.fmt.pix;
    pix.width = static_cast<std::uint32_t>(size.width);
    pix.height = static_cast<std::uint32_t>(size.height);
    pix.pixelformat = choice.layout->fourcc;
    pix.field = V4L2_FIELD_NONE;
    pix.priv = V4L2_PIX_FMT_PRIV_MAGIC;
  }
  return format;
}

bool areFieldsApart(std::uint32_t field) {
  return field == V4L2_FIELD_ALTERNATE || field == V4L2_FIELD_SEQ_TB || field == V4L2_FIELD_SEQ_BT;
}

Error refused(const Device& device, std::string problem) {
  return {.kind = ErrorKind::kUnsupported,
          .subject = device.node(),
          .problem = std::move(problem),
          .remedy = "ask for another size (camera.size), or choose another camera"};
}

Result<Negotiated> understood(const Device& device, const PlainFormat& format) {
  const Layout* layout = findLayout(format.fourcc);
  if (layout == nullptr) {
    return tl::unexpected(refused(
        device,
        "answers with the pixel format " + fourccText(format.fourcc) + ", which is not supported"));
  }
  constexpr std::uint32_t kMost = kMaxSidePixels + 1;
  const FrameSize size{static_cast<int>(std::min(format.width, kMost)),
                       static_cast<int>(std::min(format.height, kMost))};
  if (!isAcceptedSize(size)) {
    return tl::unexpected(refused(device, "answers with frames of " + std::to_string(format.width) +
                                              "x" + std::to_string(format.height) + " px"));
  }
  if (areFieldsApart(format.field)) {
    return tl::unexpected(
        refused(device, "delivers the two fields of a frame separately (interlaced)"));
  }
  if (format.memoryPlanes != layout->memoryPlanes) {
    return tl::unexpected(refused(device, "answers with " + std::to_string(format.memoryPlanes) +
                                              " planes of " + fourccText(format.fourcc)));
  }
  Negotiated negotiated{
      .layout = layout, .stream = {}, .places = {}, .imageBytes = format.imageBytes};
  FrameFormat& frame = negotiated.stream.frame;
  frame.pixelFormat = layout->pixelFormat;
  frame.size = size;
  if (layout->isJpeg) {  // JFIF's encoding, whatever the driver reports
    frame.encoding = {.matrix = ColorMatrix::kBt601, .range = ColorRange::kFull};
    return negotiated;
  }
  if (isYCbCr(frame.pixelFormat)) {
    frame.encoding = colorEncodingOf(format.colorspace, format.encoding, format.quantization);
  }
  frame.encoding = withColorimetry(frame.encoding, format.colorspace, format.transfer);
  // A stride smaller than a packed row is invalid; such a driver is assumed to pack its rows.
  std::array<std::size_t, 3> strides = format.strides;
  for (int plane = 0; plane < layout->memoryPlanes; ++plane) {
    std::size_t& stride = strides.at(static_cast<std::size_t>(plane));
    if (stride < rowBytes(frame.pixelFormat, plane, size.width)) stride = 0;
  }
  negotiated.places = planePlaces(*layout, size, strides);
  return negotiated;
}

/// Sets the frame rate if the device has one, and reads it back.
std::optional<Duration> negotiatePeriod(const Device& device, std::optional<Duration> wanted) {
  v4l2_streamparm parameters{};
  parameters.type = device.bufferType();
  if (device.ask(VIDIOC_G_PARM, parameters) < 0) return std::nullopt;
  v4l2_captureparm& capture = parameters.parm.capture;
  if (wanted && (capture.capability & V4L2_CAP_TIMEPERFRAME) != 0) {
    capture.timeperframe = fractionOf(*wanted);
    // A refused rate is no error: the current one is read back.
    device.ask(VIDIOC_S_PARM, parameters);
    parameters = {};
    parameters.type = device.bufferType();
    if (device.ask(VIDIOC_G_PARM, parameters) < 0) return std::nullopt;
  }
  return durationOf(parameters.parm.capture.timeperframe);
}

/// Makes the signal timings of a digital input (HDMI) the capture timings. Other devices have none.
Result<void> adoptTimings(const Device& device) {
  v4l2_dv_timings timings{};
  const int answer = device.ask(VIDIOC_QUERY_DV_TIMINGS, timings);
  if (answer == -ENOLINK || answer == -ENOLCK || answer == -ERANGE) {
    Error error = device.failure("receives no signal, or an unsupported one", answer);
    error.kind = ErrorKind::kDeviceLost;
    error.remedy = "connect the source and switch it on";
    return tl::unexpected(std::move(error));
  }
  if (answer < 0) return {};
  if (const int set = device.ask(VIDIOC_S_DV_TIMINGS, timings); set < 0) {
    return tl::unexpected(device.failure("cannot set its input's timings", set));
  }
  return {};
}

}  // namespace

std::optional<FrameSize> currentSize(const Device& device) {
  v4l2_format format{};
  format.type = device.bufferType();
  if (device.ask(VIDIOC_G_FMT, format) < 0) return std::nullopt;
  const PlainFormat current = plain(format, device.isMultiPlanar());
  constexpr std::uint32_t kMost = kMaxSidePixels;
  const FrameSize size{static_cast<int>(std::min(current.width, kMost)),
                       static_cast<int>(std::min(current.height, kMost))};
  return isAcceptedSize(size) ? std::optional(size) : std::nullopt;
}

std::optional<Duration> durationOf(const v4l2_fract& period) {
  if (period.numerator == 0 || period.denominator == 0) return std::nullopt;
  const auto nanoseconds = std::uint64_t{period.numerator} * 1'000'000'000 / period.denominator;
  return Duration(static_cast<Duration::rep>(std::max<std::uint64_t>(nanoseconds, 1)));
}

v4l2_fract fractionOf(Duration period) {
  constexpr double kSame = 1e-6;
  const double rate =
      static_cast<double>(Duration(1s).count()) / static_cast<double>(period.count());
  const double whole = std::round(rate);
  if (whole >= 1 && std::abs(rate / whole - 1) < kSame) {
    return {.numerator = 1, .denominator = static_cast<std::uint32_t>(whole)};
  }
  const double ntsc = std::round(rate * 1.001);
  if (ntsc >= 1 && std::abs(rate * 1.001 / ntsc - 1) < kSame) {
    return {.numerator = 1001, .denominator = static_cast<std::uint32_t>(ntsc) * 1000};
  }
  using Ticks = std::chrono::duration<std::uint32_t, std::ratio<1, 10'000'000>>;
  return {.numerator = std::chrono::ceil<Ticks>(period).count(), .denominator = Ticks::period::den};
}

Result<Negotiated> negotiate(const Device& device, const StreamRequest& request) {
  if (const Result<void> adopted = adoptTimings(device); !adopted) {
    return tl::unexpected(adopted.error());
  }
  const Result<ModeChoice> choice = chooseMode(device, request);
  if (!choice) return tl::unexpected(choice.error());
  v4l2_format format = requestOf(device, *choice);
  if (const int answer = device.ask(VIDIOC_S_FMT, format); answer < 0) {
    return tl::unexpected(device.failure(
        "cannot set the pixel format " + fourccText(choice->layout->fourcc), answer));
  }
  Result<Negotiated> negotiated = understood(device, plain(format, device.isMultiPlanar()));
  if (negotiated) negotiated->stream.framePeriod = negotiatePeriod(device, choice->period);
  return negotiated;
}

}  // namespace pleinair::hal::v4l2
