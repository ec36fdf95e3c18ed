#include "hal/outputs/v4l2_loopback/loopback_output.h"

#include <array>
#include <cassert>
#include <cerrno>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include <linux/videodev2.h>

#include "hal/file_descriptor.h"
#include "hal/outputs/v4l2_loopback/negotiation.h"
#include "hal/v4l2/capability.h"
#include "hal/v4l2/written_nodes.h"

namespace pleinair::hal {
namespace {

constexpr std::string_view kName = "loopback";

class LoopbackOutput final : public MemoryOutput {
 public:
  LoopbackOutput(std::string device, std::optional<PixelFormat> layout, const V4l2System& system)
      : device_(std::move(device)), layout_(layout), system_(system) {}
  ~LoopbackOutput() override { stopStream(); }
  LoopbackOutput(const LoopbackOutput&) = delete;
  LoopbackOutput& operator=(const LoopbackOutput&) = delete;

  OutputIdentity identity() const override {
    return {.backend = std::string(kName), .id = device_.empty() ? std::string(kName) : device_};
  }

  Result<OutputFormat> start(const OutputRequest& request) override {
    assert(!descriptor_);
    if (!isAcceptedSize(request.size)) {
      return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                  .subject = identity().id,
                                  .problem = "cannot take this size",
                                  .remedy = "use 1 to 8192 px a side and at most 64 Mpx"});
    }
    Result<OpenLoopback> opened = openLoopbackNode(device_, system_);
    if (!opened) return tl::unexpected(opened.error());
    device_ = std::move(opened->node);
    descriptor_ = std::move(opened->descriptor);
    written_.emplace(device_);
    const Result<loopback::Agreement> agreement =
        loopback::negotiate(calls(), descriptor_.get(), device_, request, layout_);
    if (!agreement) return tl::unexpected(agreement.error());
    frame_.assign(agreement->frameBytes, 0);
    picture_ = agreement->layout;
    if (request.framePeriod) {
      loopback::announceRate(calls(), descriptor_.get(), *request.framePeriod);
    }
    startStream();
    return OutputFormat{.frame = picture_.format, .refresh = std::nullopt};
  }

  Result<void> write(const ImageView& picture, Duration) override {
    assert(descriptor_);
    picture_.pack(picture, frame_);
    const std::int64_t written = calls().write(descriptor_.get(), frame_);
    if (written == -EAGAIN) {
      ++skipped_;
      return {};
    }
    if (written < 0) return tl::unexpected(failure(static_cast<int>(-written)));
    if (written == static_cast<std::int64_t>(frame_.size())) return {};
    return tl::unexpected(Error{.kind = ErrorKind::kIo,
                                .subject = device_,
                                .problem = "took " + std::to_string(written) + " of the " +
                                           std::to_string(frame_.size()) + " bytes of a picture",
                                .remedy = "something else changed its format: start again"});
  }

  Result<void> finish() override {
    assert(descriptor_);
    stopStream();
    descriptor_.reset();
    written_.reset();
    return {};
  }

  std::uint64_t skippedPictures() const override { return skipped_; }

 private:
  v4l2::SystemCalls& calls() const { return *system_.calls; }

  /// Newer versions of v4l2loopback refuse without buffers of ours, and start with the first
  /// write(). Those before 0.13 want it: closed without, a device with exclusive_caps=1 takes no
  /// pictures any more until the module is loaded again (its issue 470).
  void startStream() {
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    isStreaming_ = calls().ioctl(descriptor_.get(), VIDIOC_STREAMON, &type) >= 0;
  }
  /// 0.13 counts these: without, a reader that stays holds the format for good.
  void stopStream() {
    int type = V4L2_BUF_TYPE_VIDEO_OUTPUT;
    if (!std::exchange(isStreaming_, false)) return;
    calls().ioctl(descriptor_.get(), VIDIOC_STREAMOFF, &type);
  }

  Error failure(int errnoValue) const {
    if (errnoValue == EBUSY) return loopbackInUse(device_);
    Error error = errnoError(device_, "cannot write", errnoValue);
    const bool isLost = errnoValue == ENODEV || errnoValue == ENXIO || errnoValue == EIO;
    error.kind = isLost ? ErrorKind::kDeviceLost : ErrorKind::kIo;
    return error;
  }

  std::string device_;  ///< as named, then its node
  std::optional<PixelFormat> layout_;
  V4l2System system_;
  FileDescriptor descriptor_;
  std::optional<v4l2::WrittenNode> written_;
  loopback::FrameLayout picture_;
  std::vector<std::uint8_t> frame_;
  std::uint64_t skipped_ = 0;
  bool isStreaming_ = false;
};

Error invalid(const std::string& name, std::string problem, std::string remedy) {
  return {.kind = ErrorKind::kInvalidArgument,
          .subject = name,
          .problem = std::move(problem),
          .remedy = std::move(remedy)};
}

bool isLoopbackName(const std::string& name) {
  return name == kName || name.starts_with(std::string(kName) + ":");
}

/// The words of the option, and what they mean.
constexpr std::string_view kFormatOption = "format";
constexpr std::array kLayouts{std::pair{std::string_view("yuyv"), PixelFormat::kYuyv},
                              std::pair{std::string_view("nv12"), PixelFormat::kNv12},
                              std::pair{std::string_view("i420"), PixelFormat::kI420}};

/// Unset for "auto", and where the option is not given.
Result<std::optional<PixelFormat>> layoutOf(const OutputOptions& options) {
  const auto given = options.find(kFormatOption);
  if (given == options.end() || given->second == "auto") return std::nullopt;
  for (const auto& [word, layout] : kLayouts) {
    if (given->second == word) return layout;
  }
  return tl::unexpected(
      invalid(std::string(kName), "cannot write " + given->second, "give yuyv, nv12 or i420"));
}

OutputDescription descriptionOf(const LoopbackDevice& device) {
  return {.target = std::string(kName) + ":" + device.node,
          .name = device.card,
          .formats = device.layouts,
          .isBusy = !device.problem && !device.isWritable,
          .problem = device.problem};
}

OutputListing listing() {
  OutputListing listing;
  for (const LoopbackDevice& each : listLoopbacks()) listing.outputs.push_back(descriptionOf(each));
  if (listing.outputs.empty()) {
    listing.problem = Error{.kind = ErrorKind::kNotFound,
                            .subject = std::string(kName),
                            .problem = "there is no device",
                            .remedy = kLoadLoopback};
  }
  return listing;
}

std::string deviceOf(const std::string& target) {
  return target == kName ? "" : target.substr(kName.size() + 1);
}

std::optional<Error> problemOf(const std::string& target) {
  const Result<OpenLoopback> opened = openLoopbackNode(deviceOf(target));
  return opened ? std::nullopt : std::optional(opened.error());
}

Result<std::unique_ptr<Output>> make(const std::string& target, const OutputOptions& options) {
  const Result<std::optional<PixelFormat>> layout = layoutOf(options);
  if (!layout) return tl::unexpected(layout.error());
  return openLoopback(target, *layout);
}

}  // namespace

OutputKind loopbackKind() {
  return {.name = std::string(kName),
          .help = "a V4L2 device that other programs read as a camera, by node or label",
          .forms = {"loopback", "loopback:DEVICE"},
          .traits = {.isPaced = true, .reopens = true},
          .options = {{.name = std::string(kFormatOption),
                       .help = "The layout of its pictures; \"auto\": what the device takes.",
                       .choices = {"auto", "yuyv", "nv12", "i420"}}},
          .recognizes = isLoopbackName,
          .list = listing,
          .problemOf = problemOf,
          .make = make};
}

Result<std::unique_ptr<MemoryOutput>> openLoopback(const std::string& name,
                                                   std::optional<PixelFormat> layout,
                                                   const V4l2System& system) {
  if (!isLoopbackName(name) || (name != kName && deviceOf(name).empty())) {
    return tl::unexpected(invalid(name, "names no loopback",
                                  "give loopback, loopback:/dev/video50 or loopback:LABEL"));
  }
  if (layout && *layout != PixelFormat::kYuyv && *layout != PixelFormat::kNv12 &&
      *layout != PixelFormat::kI420) {
    return tl::unexpected(
        invalid(name, "cannot write " + std::string(toString(*layout)), "give yuyv, nv12 or i420"));
  }
  return std::make_unique<LoopbackOutput>(deviceOf(name), layout, system);
}

}  // namespace pleinair::hal
