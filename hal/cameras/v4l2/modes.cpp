#include "hal/cameras/v4l2/modes.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <string>
#include <tuple>

#include <fmt/format.h>
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
  return {.choice = {.layout = &layout,
                     .size = size,
                     .period = request.framePeriod,
                     .periods = periods,
                     .reason = {}},
          .cost = {request.pixelFormat && *request.pixelFormat != layout.pixelFormat,
                   layout.pixelFormat == PixelFormat::kGrey8 &&
                       request.pixelFormat != PixelFormat::kGrey8,
                   size && wantedSize ? distance(*size, *wantedSize) : 0,
                   shortfall(periods, wanted), layout.isJpeg, &layout - layouts().data()}};
}

std::string rateText(Duration period) {
  return fmt::format("{:.4g}",
                     1e9 / static_cast<double>(std::max<Duration::rep>(period.count(), 1)));
}

std::string sizeText(FrameSize size) {
  return fmt::format("{}x{}", size.width, size.height);
}

/// The criterion of Cost that decided between two candidates, the better one first.
std::string decisionText(const Candidate& best, const Candidate& next, Duration wantedPeriod) {
  const std::string other = fourccText(next.choice.layout->fourcc);
  const auto [format, grey, size, late, jpeg, rank] = best.cost;
  const auto [nextFormat, nextGrey, nextSize, nextLate, nextJpeg, nextRank] = next.cost;
  if (format != nextFormat) return fmt::format("{} is not the pixel format asked for", other);
  if (grey != nextGrey) return other + " has no colour";
  if (size != nextSize) {
    return fmt::format("{} comes no nearer than {} px", other,
                       sizeText(next.choice.size.value_or(FrameSize{})));
  }
  if (late != nextLate) {
    return fmt::format("{} reaches {} of {} frames/s at that size", other,
                       rateText(next.choice.periods.front()), rateText(wantedPeriod));
  }
  if (jpeg != nextJpeg) return other + " is compressed";
  return other + " costs more to paint";
}

/// Why the best of the candidates is that: what it lacks of the wish, and what the next best lacks
/// beside it.
std::string reasonText(const std::vector<Candidate>& candidates, const Candidate& best,
                       std::optional<FrameSize> wantedSize, Duration wantedPeriod) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  const std::optional<FrameSize> size = best.choice.size;
  if (size && wantedSize && *size != *wantedSize) {
    add(fmt::format("nearest to {} px", sizeText(*wantedSize)));
  }
  if (std::get<3>(best.cost) > Duration::zero()) {
    add(fmt::format("no mode of that size is faster than {} frames/s",
                    rateText(best.choice.periods.front())));
  }
  const Candidate* next = nullptr;
  for (const Candidate& each : candidates) {
    if (each.choice.layout == best.choice.layout) continue;
    if (next == nullptr || each.cost < next->cost) next = &each;
  }
  add(next == nullptr ? "no other format of it is read" : decisionText(best, *next, wantedPeriod));
  return text;
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
  std::vector<Candidate> candidates;
  for (const DeviceFormat& format : formats) {
    const Layout* layout = findLayout(format.fourcc);
    if (layout == nullptr) continue;
    if (format.sizes.empty()) {
      candidates.push_back(candidateOf(device, *layout, wantedSize, request, wantedSize));
    }
    for (const SizeRange& range : format.sizes) {
      const FrameSize size = range.nearestTo(wantedSize.value_or(range.largest));
      if (!isAcceptedSize(size)) continue;
      candidates.push_back(candidateOf(device, *layout, size, request, wantedSize));
    }
  }
  if (candidates.empty()) return tl::unexpected(nothingToChoose(device, formats));
  const Candidate& best = *std::ranges::min_element(candidates, {}, &Candidate::cost);
  ModeChoice choice = best.choice;
  choice.reason =
      reasonText(candidates, best, request.size, request.framePeriod.value_or(kFluentPeriod));
  return choice;
}

}  // namespace pleinair::hal::v4l2
