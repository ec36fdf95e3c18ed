#include "hal/cameras/libcamera/lc_device.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hal/cameras/libcamera/frame_layout.h"
#include "hal/cameras/libcamera/lc_controls.h"
#include "hal/cameras/libcamera/lc_stream.h"

namespace pleinair::hal::libcamera {
namespace {

ColorPrimaries primariesOf(lc::ColorSpace::Primaries primaries) {
  switch (primaries) {
    case lc::ColorSpace::Primaries::Smpte170m:
      return ColorPrimaries::kSmpte170m;
    case lc::ColorSpace::Primaries::Rec709:
      return ColorPrimaries::kBt709;
    case lc::ColorSpace::Primaries::Rec2020:
      return ColorPrimaries::kBt2020;
    default:
      return ColorPrimaries::kOther;
  }
}

ColorTransfer transferOf(lc::ColorSpace::TransferFunction transfer) {
  switch (transfer) {
    case lc::ColorSpace::TransferFunction::Linear:
      return ColorTransfer::kLinear;
    case lc::ColorSpace::TransferFunction::Srgb:
      return ColorTransfer::kSrgb;
    case lc::ColorSpace::TransferFunction::Rec709:
      return ColorTransfer::kBt709;
    default:
      return ColorTransfer::kOther;
  }
}

ColorEncoding encodingOf(const std::optional<lc::ColorSpace>& space) {
  ColorEncoding encoding;
  if (!space) return encoding;
  const bool isHd = space->ycbcrEncoding == lc::ColorSpace::YcbcrEncoding::Rec709 ||
                    space->ycbcrEncoding == lc::ColorSpace::YcbcrEncoding::Rec2020;
  encoding.matrix = isHd ? ColorMatrix::kBt709 : ColorMatrix::kBt601;
  encoding.range =
      space->range == lc::ColorSpace::Range::Full ? ColorRange::kFull : ColorRange::kLimited;
  encoding.primaries = primariesOf(space->primaries);
  encoding.transfer = transferOf(space->transferFunction);
  return encoding;
}

#if PLEINAIR_LIBCAMERA_VERSION >= 200
lc::Orientation orientationOf(Orientation orientation) {
  switch (orientation) {
    case Orientation::kRotated180:
      return lc::Orientation::Rotate180;
    case Orientation::kMirrored:
      return lc::Orientation::Rotate0Mirror;
    case Orientation::kFlipped:
      return lc::Orientation::Rotate180Mirror;
    default:
      return lc::Orientation::Rotate0;
  }
}
#else
lc::Transform transformOf(Orientation orientation) {
  switch (orientation) {
    case Orientation::kRotated180:
      return lc::Transform::Rot180;
    case Orientation::kMirrored:
      return lc::Transform::HFlip;
    case Orientation::kFlipped:
      return lc::Transform::VFlip;
    default:
      return lc::Transform::Identity;
  }
}
#endif

lc::Size sizeOf(FrameSize size) {
  return {static_cast<unsigned>(size.width), static_cast<unsigned>(size.height)};
}

StreamImage imageOf(const lc::StreamConfiguration& stream) {
  return {.fourcc = stream.pixelFormat.fourcc(),
          .size = {static_cast<int>(stream.size.width), static_cast<int>(stream.size.height)},
          .strideBytes = stream.stride};
}

class LibcameraDevice final : public Device {
 public:
  LibcameraDevice(std::shared_ptr<Manager> manager, std::shared_ptr<lc::Camera> camera)
      : manager_(std::move(manager)), camera_(std::move(camera)) {}
  ~LibcameraDevice() override {
    configuration_.reset();
    camera_->release();
  }

  std::string description() const override {
    const std::string model = modelOf(*camera_);
    return model.empty() ? camera_->id() : model;
  }

  std::vector<OfferedFormat> formats() override {
    std::vector<OfferedFormat> offered;
    const auto configuration = generate({lc::StreamRole::Viewfinder});
    if (!configuration) return offered;
    const lc::StreamFormats& formats = configuration->at(0).formats();
    for (const lc::PixelFormat& format : formats.pixelformats()) {
      OfferedFormat each{.fourcc = format.fourcc()};
      for (const lc::Size& size : formats.sizes(format)) {
        each.sizes.push_back({static_cast<int>(size.width), static_cast<int>(size.height)});
      }
      if (format.modifier() == 0) offered.push_back(std::move(each));
    }
    return offered;
  }

  Result<StreamAnswer> configure(const StreamWish& wish) override {
    if (wish.luma && configurePair(wish)) return answerTo(wish);
    configuration_ = generate({lc::StreamRole::Viewfinder});
    if (!configuration_) {
      return tl::unexpected(
          Error{.kind = ErrorKind::kUnsupported, .problem = "has no stream for video"});
    }
    ask(wish);
    const std::string asked = configuration_->at(0).toString();
    if (configuration_->validate() == lc::CameraConfiguration::Invalid) {
      return tl::unexpected(
          Error{.kind = ErrorKind::kUnsupported, .problem = "cannot be configured for " + asked});
    }
    if (const int answer = camera_->configure(configuration_.get()); answer < 0) {
      return tl::unexpected(errnoError({}, "cannot be configured for " + asked, -answer));
    }
    return answerTo(wish);
  }

  std::optional<ControlRange> range(Control control) override { return rangeOf(*camera_, control); }
  bool hasAutomatic(Control control) override { return libcamera::hasAutomatic(*camera_, control); }
  std::optional<std::array<Duration, 2>> periods() override { return periodsOf(*camera_); }

  Result<std::unique_ptr<Stream>> start(const StartSettings& settings) override {
    lc::Stream* const luma = configuration_->size() > 1 ? configuration_->at(1).stream() : nullptr;
    auto stream =
        std::make_unique<LibcameraStream>(manager_, camera_, configuration_->at(0).stream(), luma);
    const Result<void> begun = stream->begin(controlsOf(*camera_, settings));
    if (!begun) return tl::unexpected(begun.error());
    return stream;
  }

 private:
  /// A configuration of as many streams as roles; null: the camera has none.
  std::unique_ptr<lc::CameraConfiguration> generate(const std::vector<lc::StreamRole>& roles) {
    auto configuration = camera_->generateConfiguration(roles);
    if (!configuration || configuration->size() != roles.size()) return nullptr;
    return configuration;
  }

  /// Asks for what is wished of the frames, and of them alone.
  void ask(const StreamWish& wish) {
    lc::StreamConfiguration& stream = configuration_->at(0);
    stream.pixelFormat = lc::PixelFormat(wish.fourcc);
    stream.size = sizeOf(wish.size);
    stream.bufferCount = static_cast<unsigned>(wish.buffers);
#if PLEINAIR_LIBCAMERA_VERSION >= 200
    configuration_->orientation = orientationOf(wish.orientation);
#else
    configuration_->transform = transformOf(wish.orientation);
#endif
  }

  /// Configures two streams. False where libcamera makes one image of a frame only, or none with
  /// a plane of luma beside it.
  bool configurePair(const StreamWish& wish) {
    // The roles that handlers give different outputs of their image processors for.
    configuration_ = generate({lc::StreamRole::VideoRecording, lc::StreamRole::Viewfinder});
    if (!configuration_) return false;
    lc::StreamConfiguration& luma = configuration_->at(1);
    const std::vector<lc::PixelFormat> offered = luma.formats().pixelformats();
    const auto format = std::ranges::find_if(lumaFourccs(), [&](std::uint32_t each) {
      return std::ranges::find(offered, lc::PixelFormat(each)) != offered.end();
    });
    if (format == lumaFourccs().end()) return false;
    ask(wish);
    luma.pixelFormat = lc::PixelFormat(*format);
    luma.size = sizeOf(*wish.luma);
    luma.bufferCount = static_cast<unsigned>(wish.buffers);
    return configuration_->validate() != lc::CameraConfiguration::Invalid &&
           configuration_->size() == 2 && camera_->configure(configuration_.get()) >= 0;
  }

  StreamAnswer answerTo(const StreamWish& wish) const {
    const lc::StreamConfiguration& stream = configuration_->at(0);
    const StreamImage image = imageOf(stream);
    StreamAnswer answer{.fourcc = image.fourcc,
                        .size = image.size,
                        .strideBytes = image.strideBytes,
                        .encoding = encodingOf(stream.colorSpace)};
#if PLEINAIR_LIBCAMERA_VERSION >= 200
    answer.isOrientationKept = configuration_->orientation == orientationOf(wish.orientation);
#else
    answer.isOrientationKept = configuration_->transform == transformOf(wish.orientation);
#endif
    if (configuration_->size() > 1) answer.luma = imageOf(configuration_->at(1));
    return answer;
  }

  std::shared_ptr<Manager> manager_;
  std::shared_ptr<lc::Camera> camera_;
  std::unique_ptr<lc::CameraConfiguration> configuration_;
};

}  // namespace

std::unique_ptr<Device> lcDevice(std::shared_ptr<Manager> manager,
                                 std::shared_ptr<lc::Camera> camera) {
  return std::make_unique<LibcameraDevice>(std::move(manager), std::move(camera));
}

}  // namespace pleinair::hal::libcamera
