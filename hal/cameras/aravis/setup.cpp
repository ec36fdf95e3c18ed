#include "hal/cameras/aravis/setup.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "hal/cameras/missing_control.h"

namespace pleinair::hal::aravis {
namespace {

constexpr std::string_view kFree = "free";
constexpr std::string_view kSoftware = "software";

Error unsupported(std::string problem, std::string remedy) {
  return {
      .kind = ErrorKind::kUnsupported, .problem = std::move(problem), .remedy = std::move(remedy)};
}

/// The largest size within the bounds that is at most `wanted`; even, if `isEven` and the device
/// can.
int sizeWithin(const Bounds<int>& bounds, int wanted, bool isEven) {
  const int step = std::max(bounds.step, 1);
  const int bounded = std::clamp(wanted, bounds.min, bounds.max);
  const int size = bounded - (bounded - bounds.min) % step;
  return isEven && size % 2 != 0 && size - step >= bounds.min ? size - step : size;
}

/// The smallest multiple of `step` that is even.
int evenStep(int step) {
  return step % 2 == 0 ? std::max(step, 2) : 2 * step;
}

bool isMosaicOrPaired(const PixelLayout& layout) {
  return isBayer(layout.pixelFormat) || layout.pixelFormat == PixelFormat::kYuyv;
}

/// The offset of a region on the sensor: centred, or as asked for, as far as it fits.
int offsetFor(int asked, int size, int available, int step) {
  if (step <= 0) return 0;
  const int room = std::max(available - size, 0);
  const int wanted = asked < 0 ? room / 2 : std::min(asked, room);
  return wanted - wanted % step;
}

Result<void> setBinning(Device& device, int factor) {
  const std::optional<int> most = device.maxBinning();
  if (!most) {
    if (factor == 1) return {};
    return tl::unexpected(unsupported("cannot bin", "set camera.aravis.binning to 1"));
  }
  if (factor > *most) {
    return tl::unexpected(
        unsupported(fmt::format("cannot bin {} times", factor),
                    fmt::format("set camera.aravis.binning to at most {}", *most)));
  }
  return device.setBinning(factor);
}

Result<Region> setRegion(Device& device, const AravisOptions& options, const PixelLayout& layout,
                         std::optional<FrameSize> asked) {
  const Result<RegionBounds> bounds = readBounds(device);
  if (!bounds) return tl::unexpected(bounds.error());
  // A mosaic that begins at an odd pixel, or ends at one, would be another mosaic.
  const bool isEven = isMosaicOrPaired(layout);
  const auto stepOf = [&](int step) { return isEven && step > 0 ? evenStep(step) : step; };
  const FrameSize size = regionSizeFor(*bounds, layout, asked);
  Region region;
  region.width = size.width;
  region.height = size.height;
  region.x = offsetFor(options.offsetX, region.width, bounds->width.max, stepOf(bounds->xStep));
  region.y = offsetFor(options.offsetY, region.height, bounds->height.max, stepOf(bounds->yStep));
  Result<Region> set = device.setRegion(region);
  if (!set) return set;
  if (!isAcceptedSize(set->size())) {
    return tl::unexpected(
        unsupported(fmt::format("delivers {}x{}, beyond the limit", set->width, set->height),
                    fmt::format("set camera.size; a side may have {} px", kMaxSidePixels)));
  }
  return set;
}

bool isSameWord(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

Result<void> setTrigger(Device& device, const std::string& trigger) {
  if (trigger == kFree) return device.setTrigger({});
  const Result<std::vector<std::string>> sources = device.triggerSources();
  if (!sources) return tl::unexpected(sources.error());
  const auto found = std::ranges::find_if(
      *sources, [&](const std::string& each) { return isSameWord(each, trigger); });
  if (found != sources->end()) return device.setTrigger(*found);
  return tl::unexpected(
      unsupported(fmt::format("has no trigger \"{}\"", trigger),
                  fmt::format("set camera.aravis.trigger to free{}{}", sources->empty() ? "" : ", ",
                              fmt::join(*sources, ", "))));
}

constexpr std::array<std::string_view, 3> kControlNames{"exposure", "gain", "white_balance"};

std::string_view nameOf(Control control) {
  return kControlNames.at(static_cast<std::size_t>(control));
}

Error missing(Device& device, std::string_view what) {
  std::array<OfferedControl, kControlNames.size()> offered;
  for (std::size_t i = 0; i < offered.size(); ++i) {
    const auto control = static_cast<Control>(i);
    offered.at(i) = {.name = nameOf(control),
                     .hasValue = device.bounds(control).has_value(),
                     .hasAutomatic = device.hasAutomatic(control)};
  }
  return missingControl(what, offered);
}

Result<void> setAutomatic(Device& device, Control control) {
  if (!device.hasAutomatic(control)) {
    return tl::unexpected(missing(device, fmt::format("automatic {}", nameOf(control))));
  }
  return device.setAutomatic(control, true);
}

template <class ToUnits>
Result<void> setValue(Device& device, Control control, ToUnits toUnits) {
  const std::optional<Bounds<double>> bounds = device.bounds(control);
  if (!bounds) return tl::unexpected(missing(device, nameOf(control)));
  if (device.hasAutomatic(control)) {
    if (Result<void> off = device.setAutomatic(control, false); !off) return off;
  }
  const double wanted = toUnits(*bounds);
  return device.setValue(control, std::clamp(std::isnan(wanted) ? 0.0 : wanted, bounds->min,
                                             std::max(bounds->min, bounds->max)));
}

Result<void> setControls(Device& device, const CameraControls& controls) {
  if (const auto& exposure = controls.exposure) {
    const auto* time = std::get_if<Duration>(&*exposure);
    const auto set = time == nullptr
                         ? setAutomatic(device, Control::kExposure)
                         : setValue(device, Control::kExposure, [&](const Bounds<double>&) {
                             return std::chrono::duration<double, std::micro>(*time).count();
                           });
    if (!set) return set;
  }
  if (const auto& gain = controls.gain) {
    const double* share = std::get_if<double>(&*gain);
    const auto set = share == nullptr
                         ? setAutomatic(device, Control::kGain)
                         : setValue(device, Control::kGain, [&](const Bounds<double>& range) {
                             return range.min + *share * (range.max - range.min);
                           });
    if (!set) return set;
  }
  if (const auto& balance = controls.whiteBalance) {
    if (std::holds_alternative<double>(*balance)) {
      return tl::unexpected(missing(device, "white_balance in K"));
    }
    if (auto set = setAutomatic(device, Control::kWhiteBalance); !set) return set;
  }
  if (controls.focus) return tl::unexpected(missing(device, "focus"));
  return {};
}

/// The rate of a free-running camera, read back, or that of the program's own triggers.
Result<void> setRate(Device& device, const StreamRequest& request, Negotiated& negotiated) {
  if (negotiated.isLineTriggered) return {};
  negotiated.framePeriod = request.framePeriod;
  if (negotiated.isSoftwareTriggered || !request.framePeriod) return {};
  const Result<std::optional<double>> rate =
      device.setFrameRate(1.0 / toSeconds(*request.framePeriod));
  if (!rate) return tl::unexpected(rate.error());
  negotiated.framePeriod.reset();
  if (*rate && **rate > 0) negotiated.framePeriod = fromSeconds(1.0 / **rate);
  return {};
}

Result<void> setFormat(Device& device, const AravisOptions& options, const StreamRequest& request,
                       Negotiated& negotiated) {
  if (auto binned = setBinning(device, options.binning); !binned) return binned;
  const Result<std::vector<std::uint32_t>> offered = device.pixelFormats();
  if (!offered) return tl::unexpected(offered.error());
  const Result<const PixelLayout*> layout =
      chooseLayout(*offered, options.pixelFormat, request.pixelFormat);
  if (!layout) return tl::unexpected(layout.error());
  negotiated.layout = *layout;
  if (auto set = device.setPixelFormat((*layout)->pfnc); !set) return set;
  const Result<Region> region = setRegion(device, options, **layout, request.size);
  if (!region) return tl::unexpected(region.error());
  // Pairs would go on across the ends of rows.
  if ((*layout)->pixelFormat == PixelFormat::kYuyv && region->size().width % 2 != 0) {
    return tl::unexpected(
        unsupported(fmt::format("gives rows of {} px in {}, whose pixels are paired",
                                region->size().width, (*layout)->name),
                    "set camera.aravis.pixel_format to another of its formats"));
  }
  negotiated.region = *region;
  return {};
}

}  // namespace

Result<RegionBounds> readBounds(Device& device) {
  Result<RegionBounds> bounds = device.regionBounds();
  if (!bounds) return bounds;
  const auto isSane = [](Bounds<int>& side, int& offsetStep) {
    side.min = std::max(side.min, 1);
    if (side.max < side.min) return false;
    side.step = std::clamp(side.step, 1, side.max);
    offsetStep = std::clamp(offsetStep, 0, side.max);
    // A step may have to be doubled, and sides to be added to offsets.
    return side.max <= std::numeric_limits<int>::max() / 4;
  };
  if (isSane(bounds->width, bounds->xStep) && isSane(bounds->height, bounds->yStep)) return bounds;
  return tl::unexpected(
      unsupported(fmt::format("gives regions of {} to {} by {} to {} px", bounds->width.min,
                              bounds->width.max, bounds->height.min, bounds->height.max),
                  "update its firmware"));
}

FrameSize regionSizeFor(const RegionBounds& bounds, const PixelLayout& layout,
                        std::optional<FrameSize> asked) {
  const bool isEven = isMosaicOrPaired(layout);
  return {sizeWithin(bounds.width, asked ? asked->width : bounds.width.max, isEven),
          sizeWithin(bounds.height, asked ? asked->height : bounds.height.max, isEven)};
}

Result<Negotiated> setUp(Device& device, const AravisOptions& options,
                         const StreamRequest& request) {
  if (!device.isController()) {
    return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                .problem = "another program controls it",
                                .remedy = "end that program: a GigE camera obeys one at a time"});
  }
  Negotiated negotiated;
  negotiated.isSoftwareTriggered = options.trigger == kSoftware;
  negotiated.isLineTriggered = !negotiated.isSoftwareTriggered && options.trigger != kFree;
  Result<void> done = setFormat(device, options, request, negotiated);
  if (done) done = setTrigger(device, options.trigger);
  if (done) done = setRate(device, request, negotiated);
  if (done) done = setControls(device, request.controls);
  if (!done) return tl::unexpected(done.error());
  if (options.chunkTimestamps) device.enableChunkTimestamps();
  if (device.transport() == Transport::kGige) {
    const Result<int> packet = device.setPacketSize(options.packetBytes);
    if (!packet) return tl::unexpected(packet.error());
    negotiated.packetBytes = *packet;
  }
  const Result<std::size_t> payload = device.payloadBytes();
  if (!payload) return tl::unexpected(payload.error());
  // Some devices forget their chunk data, or a padding, in what they announce.
  negotiated.bufferBytes = std::max(
      *payload,
      negotiated.layout->bytesOf(static_cast<std::size_t>(negotiated.region.size().pixels())));
  return negotiated;
}

std::string linkWarning(Library& library, const Device& device, const AravisOptions& options) {
  if (device.transport() != Transport::kGige || options.socketBufferBytes == 0) return {};
  if (options.packetSocket && library.mayUsePacketSocket()) return {};
  const std::size_t granted = library.grantedSocketBuffer(options.socketBufferBytes);
  if (granted >= options.socketBufferBytes) return {};
  return fmt::format(
      "the system grants a socket buffer of {} kB of {}, so frames will be lost; "
      "sudo sysctl -w net.core.rmem_max={}",
      granted / 1000, options.socketBufferBytes / 1000, options.socketBufferBytes);
}

}  // namespace pleinair::hal::aravis
