#include "hal/cameras/v4l2/modes.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <tuple>

#include <linux/videodev2.h>

#include "hal/cameras/v4l2/format.h"
#include "hal/v4l2/formats.h"

namespace pleinair::hal::v4l2 {
namespace {

/// An upper bound on enumerations, for drivers that never answer EINVAL. No device lists as many.
constexpr std::uint32_t kMaxEntries = 256;
/// The frame period that is preferred if none is requested.
constexpr Duration kFluentPeriod = std::chrono::milliseconds(40);

FrameSize sizeOf(std::uint32_t width, std::uint32_t height) {
  const auto side = [](std::uint32_t value) {
    return static_cast<int>(std::min<std::uint32_t>(value, kMaxSidePixels + 1));
  };
  return {side(width), side(height)};
}

int nearestStep(int wanted, int smallest, int largest, int step) {
  if (wanted <= smallest || largest <= smallest) return smallest;
  if (wanted >= largest) return largest;
  const int steps = (wanted - smallest + step / 2) / step;
  return std::min(smallest + steps * step, largest);
}

std::vector<SizeRange> enumerateSizes(const Device& device, std::uint32_t fourcc) {
  std::vector<SizeRange> sizes;
  for (std::uint32_t index = 0; index < kMaxEntries; ++index) {
    v4l2_frmsizeenum entry{};
    entry.index = index;
    entry.pixel_format = fourcc;
    if (device.ask(VIDIOC_ENUM_FRAMESIZES, entry) < 0) break;
    if (entry.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      const FrameSize size = sizeOf(entry.discrete.width, entry.discrete.height);
      sizes.push_back({.smallest = size, .largest = size});
      continue;
    }
    const v4l2_frmsize_stepwise& range = entry.stepwise;
    FrameSize step = sizeOf(range.step_width, range.step_height);
    step = {std::max(step.width, 1), std::max(step.height, 1)};
    sizes.push_back({.smallest = sizeOf(range.min_width, range.min_height),
                     .largest = sizeOf(range.max_width, range.max_height),
                     .step = step});
    break;  // a range is the only entry
  }
  return sizes;
}

int distance(FrameSize a, FrameSize b) {
  return std::abs(a.width - b.width) + std::abs(a.height - b.height);
}

/// The distance of a mode from a request; smaller is better, earlier members weigh more.
using Cost = std::tuple<bool, bool, int, Duration, bool, std::ptrdiff_t>;

struct Candidate {
  ModeChoice choice;
  Cost cost;
};

Duration shortfall(const std::vector<Duration>& periods, Duration wanted) {
  if (periods.empty()) return Duration::zero();  // the driver does not say: test by streaming
  // 30 and 30000/1001 count as equal
  constexpr Duration kRounding = std::chrono::microseconds(100);
  const Duration late = periods.front() - wanted;
  return late <= wanted / 100 + kRounding ? Duration::zero() : late;
}

Candidate candidateOf(const Device& device, const Layout& layout, std::optional<FrameSize> size,
                      const StreamRequest& request, std::optional<FrameSize> wantedSize) {
  const std::vector<Duration> periods =
      size ? enumeratePeriods(device, layout.fourcc, *size) : std::vector<Duration>();
  const Duration wanted = request.framePeriod.value_or(kFluentPeriod);
  return {.choice = {.layout = &layout, .size = size, .period = request.framePeriod},
          .cost = {request.pixelFormat && *request.pixelFormat != layout.pixelFormat,
                   layout.pixelFormat == PixelFormat::kGrey8 &&
                       request.pixelFormat != PixelFormat::kGrey8,
                   size && wantedSize ? distance(*size, *wantedSize) : 0,
                   shortfall(periods, wanted), layout.isJpeg, &layout - layouts().data()}};
}

Error nothingToChoose(const Device& device, const std::vector<DeviceFormat>& formats) {
  std::string offered;
  for (const DeviceFormat& format : formats) {
    offered += (offered.empty() ? "" : ", ") + fourccText(format.fourcc);
  }
  std::string read;
  for (const Layout& layout : layouts()) {
    read += (read.empty() ? "" : ", ") + fourccText(layout.fourcc);
  }
  if (formats.empty()) {
    return {.kind = ErrorKind::kUnsupported,
            .subject = device.node(),
            .problem = "offers no pixel format now (" + device.capability().card + ")",
            .remedy = "start its source, or choose another camera"};
  }
  return {.kind = ErrorKind::kUnsupported,
          .subject = device.node(),
          .problem = "offers only " + offered,
          .remedy = "choose a camera with one of " + read};
}

}  // namespace

FrameSize SizeRange::nearestTo(FrameSize wanted) const {
  return {nearestStep(wanted.width, smallest.width, largest.width, step.width),
          nearestStep(wanted.height, smallest.height, largest.height, step.height)};
}

std::vector<DeviceFormat> enumerateFormats(const Device& device) {
  std::vector<DeviceFormat> formats;
  for (std::uint32_t index = 0; index < kMaxEntries; ++index) {
    v4l2_fmtdesc entry{};
    entry.index = index;
    entry.type = device.bufferType();
    if (device.ask(VIDIOC_ENUM_FMT, entry) < 0) break;
    formats.push_back(
        {.fourcc = entry.pixelformat, .sizes = enumerateSizes(device, entry.pixelformat)});
  }
  return formats;
}

std::vector<Duration> enumeratePeriods(const Device& device, std::uint32_t fourcc, FrameSize size) {
  std::vector<Duration> periods;
  const auto add = [&](const v4l2_fract& period) {
    if (const auto duration = durationOf(period)) periods.push_back(*duration);
  };
  for (std::uint32_t index = 0; index < kMaxEntries; ++index) {
    v4l2_frmivalenum entry{};
    entry.index = index;
    entry.pixel_format = fourcc;
    entry.width = static_cast<std::uint32_t>(size.width);
    entry.height = static_cast<std::uint32_t>(size.height);
    if (device.ask(VIDIOC_ENUM_FRAMEINTERVALS, entry) < 0) break;
    if (entry.type == V4L2_FRMIVAL_TYPE_DISCRETE) {
      add(entry.discrete);
      continue;
    }
    add(entry.stepwise.min);
    add(entry.stepwise.max);
    break;  // a range is the only entry
  }
  std::ranges::sort(periods);
  return periods;
}

std::vector<CameraMode> modesOf(const Device& device) {
  std::vector<CameraMode> modes;
  for (const DeviceFormat& format : enumerateFormats(device)) {
    for (const SizeRange& range : format.sizes) {
      modes.push_back({.layout = fourccText(format.fourcc),
                       .size = range.largest,
                       .periods = enumeratePeriods(device, format.fourcc, range.largest),
                       .isSupported = findLayout(format.fourcc) != nullptr});
    }
  }
  return modes;
}

Result<ModeChoice> chooseMode(const Device& device, const StreamRequest& request) {
  const std::vector<DeviceFormat> formats = enumerateFormats(device);
  const std::optional<FrameSize> wantedSize = request.size ? request.size : currentSize(device);
  std::optional<Candidate> best;
  const auto consider = [&](Candidate candidate) {
    if (!best || candidate.cost < best->cost) best = candidate;
  };
  for (const DeviceFormat& format : formats) {
    const Layout* layout = findLayout(format.fourcc);
    if (layout == nullptr) continue;
    if (format.sizes.empty()) {
      consider(candidateOf(device, *layout, wantedSize, request, wantedSize));
    }
    for (const SizeRange& range : format.sizes) {
      const FrameSize size = range.nearestTo(wantedSize.value_or(range.largest));
      if (!isAcceptedSize(size)) continue;
      consider(candidateOf(device, *layout, size, request, wantedSize));
    }
  }
  if (!best) return tl::unexpected(nothingToChoose(device, formats));
  return best->choice;
}

}  // namespace pleinair::hal::v4l2
