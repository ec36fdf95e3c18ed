// The only file that calls libcamera: 0.0.3 (Debian 12) to 0.7, with checks of the version where
// its interface has changed.

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include <libcamera/libcamera.h>
#include <libcamera/property_ids.h>

#include "hal/cameras/libcamera/library.h"
#include "hal/cameras/libcamera/mapped_buffer.h"

#define PLEINAIR_LIBCAMERA_VERSION \
  (LIBCAMERA_VERSION_MAJOR * 10000 + LIBCAMERA_VERSION_MINOR * 100 + LIBCAMERA_VERSION_PATCH)

namespace pleinair::hal::libcamera {
namespace {

namespace lc = ::libcamera;

// libcamera reads the variable when it first logs; it would log lines at every start. Whoever sets
// it sees them.
[[maybe_unused]] const int kIsQuiet =
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before main(), there is one thread
    setenv("LIBCAMERA_LOG_LEVELS", "*:ERROR", 0);

/// One manager a process, which is all that libcamera allows; it goes with its last user.
class Manager {
 public:
  static Result<std::shared_ptr<Manager>> shared() {
    static std::mutex mutex;
    static std::weak_ptr<Manager> current;
    const std::scoped_lock lock(mutex);
    if (auto manager = current.lock()) return manager;
    auto manager = std::make_shared<Manager>();
    if (const int answer = manager->cameras_.start(); answer < 0) {
      return tl::unexpected(errnoError("libcamera", "cannot start", -answer));
    }
    current = manager;
    return manager;
  }
  Manager() = default;
  ~Manager() { cameras_.stop(); }
  Manager(const Manager&) = delete;
  Manager& operator=(const Manager&) = delete;

  std::vector<std::shared_ptr<lc::Camera>> cameras() const { return cameras_.cameras(); }
  std::shared_ptr<lc::Camera> get(const std::string& id) { return cameras_.get(id); }

 private:
  lc::CameraManager cameras_;
};

std::string modelOf(const lc::Camera& camera) {
  const auto model = camera.properties().get(lc::properties::Model);
  return model ? std::string(*model) : std::string();
}

/// Ids of the UVC pipeline handler end in "-VVVV:PPPP", vendor and product of the USB device.
bool endsInUsbIds(const std::string& id) {
  constexpr std::size_t kLength = 10;
  if (id.size() < kLength) return false;
  const std::string tail = id.substr(id.size() - kLength);
  for (std::size_t i = 0; i < kLength; ++i) {
    const auto letter = static_cast<unsigned char>(tail[i]);
    if (i == 0 ? letter != '-' : i == 5 ? letter != ':' : std::isxdigit(letter) == 0) return false;
  }
  return true;
}

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

std::vector<BufferPlane> planesOf(const lc::FrameBuffer& buffer) {
  std::vector<BufferPlane> planes;
  for (const lc::FrameBuffer::Plane& each : buffer.planes()) {
    planes.push_back(
        {.fd = each.fd.get(),
         .offset = each.offset == lc::FrameBuffer::Plane::kInvalidOffset ? 0 : each.offset,
         .length = each.length});
  }
  return planes;
}

/// What libcamera's thread posts, and the camera's thread takes. Signals are connected to it, and
/// not to an object of libcamera's, whose slots would wait for an event loop.
class Posts {
 public:
  void complete(lc::Request* request) {
    const std::scoped_lock lock(mutex_);
    requests_.push_back(request);
    changed_.notify_one();
  }
  void disconnect() {
    const std::scoped_lock lock(mutex_);
    isLost_ = true;
    changed_.notify_one();
  }
  lc::Request* take(Duration timeout) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [this] { return isLost_ || !requests_.empty(); });
    if (requests_.empty()) return nullptr;
    lc::Request* const request = requests_.front();
    requests_.pop_front();
    return request;
  }
  bool isLost() const {
    const std::scoped_lock lock(mutex_);
    return isLost_;
  }

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<lc::Request*> requests_;
  bool isLost_ = false;
};

class LibcameraStream final : public Stream {
 public:
  LibcameraStream(std::shared_ptr<Manager> manager, std::shared_ptr<lc::Camera> camera,
                  lc::Stream* stream)
      : manager_(std::move(manager)),
        camera_(std::move(camera)),
        stream_(stream),
        allocator_(std::make_unique<lc::FrameBufferAllocator>(camera_)) {
    camera_->requestCompleted.connect(&posts_, &Posts::complete);
    camera_->disconnected.connect(&posts_, &Posts::disconnect);
  }
  // The order is libcamera's: stop, requests, buffers, and the rest by the members.
  ~LibcameraStream() override {
    camera_->stop();
    camera_->requestCompleted.disconnect(&posts_);
    camera_->disconnected.disconnect(&posts_);
    requests_.clear();
    buffers_.clear();
    allocator_->free(stream_);
  }

  Result<void> begin(const lc::ControlList& controls) {
    if (const int answer = allocator_->allocate(stream_); answer < 0) {
      return tl::unexpected(errnoError({}, "cannot allocate buffers", -answer));
    }
    for (const std::unique_ptr<lc::FrameBuffer>& buffer : allocator_->buffers(stream_)) {
      auto mapped = MappedBuffer::map(planesOf(*buffer));
      if (!mapped) return tl::unexpected(mapped.error());
      std::unique_ptr<lc::Request> request = camera_->createRequest(requests_.size());
      if (!request || request->addBuffer(stream_, buffer.get()) < 0) {
        return tl::unexpected(Error{.kind = ErrorKind::kIo, .problem = "cannot make a request"});
      }
      buffers_.push_back(*std::move(mapped));
      requests_.push_back(std::move(request));
    }
    if (const int answer = camera_->start(&controls); answer < 0) {
      return tl::unexpected(errnoError({}, "cannot start streaming", -answer));
    }
    for (const auto& request : requests_) {
      if (const int answer = camera_->queueRequest(request.get()); answer < 0) {
        return tl::unexpected(errnoError({}, "refuses to queue its buffers", -answer));
      }
    }
    return {};
  }

  std::size_t bufferCount() const override { return requests_.size(); }
  std::shared_ptr<const BufferMemory> memory(std::size_t index) const override {
    return {buffers_[index], &buffers_[index]->memory};
  }

  std::optional<Completed> pop(Duration timeout) override {
    lc::Request* const request = posts_.take(std::max(timeout, Duration::zero()));
    if (request == nullptr) return std::nullopt;
    Completed completed{.index = static_cast<std::size_t>(request->cookie())};
    const lc::FrameBuffer* const buffer = request->findBuffer(stream_);
    completed.isCancelled = request->status() == lc::Request::RequestCancelled;
    if (buffer == nullptr || completed.isCancelled) return completed;
    const lc::FrameMetadata& metadata = buffer->metadata();
    completed.isFaulty = metadata.status != lc::FrameMetadata::FrameSuccess;
    completed.sequence = metadata.sequence;
    completed.timestamp = Duration(static_cast<std::int64_t>(metadata.timestamp));
    if (const auto time = request->metadata().get(lc::controls::SensorTimestamp)) {
      completed.sensorTime = Duration(*time);
    }
    const auto planes = metadata.planes();
    for (std::size_t i = 0; i < std::min<std::size_t>(planes.size(), 3); ++i) {
      completed.usedBytes.at(i) = planes[i].bytesused;
    }
    return completed;
  }

  int push(std::size_t index) override {
    requests_[index]->reuse(lc::Request::ReuseBuffers);
    return camera_->queueRequest(requests_[index].get());
  }
  bool isLost() const override { return posts_.isLost(); }

 private:
  std::shared_ptr<Manager> manager_;
  std::shared_ptr<lc::Camera> camera_;
  lc::Stream* stream_;
  Posts posts_;
  std::unique_ptr<lc::FrameBufferAllocator> allocator_;
  std::vector<std::shared_ptr<MappedBuffer>> buffers_;
  std::vector<std::unique_ptr<lc::Request>> requests_;
};

double numberIn(const lc::ControlValue& value) {
  switch (value.type()) {
    case lc::ControlTypeInteger32:
      return value.get<std::int32_t>();
    case lc::ControlTypeInteger64:
      return static_cast<double>(value.get<std::int64_t>());
    case lc::ControlTypeFloat:
      return static_cast<double>(value.get<float>());
    default:
      return 0;
  }
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
    const auto configuration = generate();
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
    configuration_ = generate();
    if (!configuration_) {
      return tl::unexpected(
          Error{.kind = ErrorKind::kUnsupported, .problem = "has no stream for video"});
    }
    lc::StreamConfiguration& stream = configuration_->at(0);
    stream.pixelFormat = lc::PixelFormat(wish.fourcc);
    stream.size = {static_cast<unsigned>(wish.size.width), static_cast<unsigned>(wish.size.height)};
    stream.bufferCount = static_cast<unsigned>(wish.buffers);
#if PLEINAIR_LIBCAMERA_VERSION >= 200
    configuration_->orientation = orientationOf(wish.orientation);
#else
    configuration_->transform = transformOf(wish.orientation);
#endif
    if (configuration_->validate() == lc::CameraConfiguration::Invalid) {
      return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                  .problem = "cannot be configured for " + stream.toString()});
    }
    if (const int answer = camera_->configure(configuration_.get()); answer < 0) {
      return tl::unexpected(
          errnoError({}, "cannot be configured for " + stream.toString(), -answer));
    }
    StreamAnswer answer{
        .fourcc = stream.pixelFormat.fourcc(),
        .size = {static_cast<int>(stream.size.width), static_cast<int>(stream.size.height)},
        .strideBytes = stream.stride,
        .encoding = encodingOf(stream.colorSpace)};
#if PLEINAIR_LIBCAMERA_VERSION >= 200
    answer.isOrientationKept = configuration_->orientation == orientationOf(wish.orientation);
#else
    answer.isOrientationKept = configuration_->transform == transformOf(wish.orientation);
#endif
    return answer;
  }

  std::optional<ControlRange> range(Control control) override {
    const lc::ControlId* const id = valueControl(control);
    const lc::ControlInfo* const info = infoOf(id);
    if (info == nullptr) return std::nullopt;
    return ControlRange{.min = numberIn(info->min()), .max = numberIn(info->max())};
  }
  bool hasAutomatic(Control control) override {
    return infoOf(automaticControl(control)) != nullptr;
  }

  std::optional<std::array<Duration, 2>> periods() override {
    const lc::ControlInfo* const info = infoOf(&lc::controls::FrameDurationLimits);
    if (info == nullptr) return std::nullopt;
    const auto microseconds = [](const lc::ControlValue& value) {
      return Duration(std::chrono::microseconds(static_cast<std::int64_t>(numberIn(value))));
    };
    return std::array{microseconds(info->min()), microseconds(info->max())};
  }

  Result<std::unique_ptr<Stream>> start(const StartSettings& settings) override {
    lc::ControlList controls(camera_->controls());
    for (const Control control : kControls) {
      const auto& setting = settings.controls.at(static_cast<std::size_t>(control));
      if (setting) add(control, *setting, controls);
    }
    if (settings.framePeriod) {
      const auto period =
          std::chrono::duration_cast<std::chrono::microseconds>(*settings.framePeriod).count();
      const std::array<std::int64_t, 2> limits{period, period};
      controls.set(lc::controls::FrameDurationLimits, lc::Span<const std::int64_t, 2>(limits));
    }
    auto stream =
        std::make_unique<LibcameraStream>(manager_, camera_, configuration_->at(0).stream());
    if (auto begun = stream->begin(controls); !begun) return tl::unexpected(begun.error());
    return stream;
  }

 private:
  std::unique_ptr<lc::CameraConfiguration> generate() {
    auto configuration = camera_->generateConfiguration({lc::StreamRole::Viewfinder});
    if (!configuration || configuration->empty()) return nullptr;
    return configuration;
  }

  static const lc::ControlId* valueControl(Control control) {
    switch (control) {
      case Control::kExposure:
        return &lc::controls::ExposureTime;
      case Control::kGain:
        return &lc::controls::AnalogueGain;
      case Control::kFocus:
        return &lc::controls::LensPosition;
      case Control::kWhiteBalance:
        return &lc::controls::ColourTemperature;
    }
    return nullptr;
  }
  /// Exposure and gain have modes of their own from 0.5 on, and share one switch before.
  static const lc::ControlId* automaticControl(Control control) {
    switch (control) {
      case Control::kExposure:
#if PLEINAIR_LIBCAMERA_VERSION >= 500
        return &lc::controls::ExposureTimeMode;
#else
        return &lc::controls::AeEnable;
#endif
      case Control::kGain:
#if PLEINAIR_LIBCAMERA_VERSION >= 500
        return &lc::controls::AnalogueGainMode;
#else
        return &lc::controls::AeEnable;
#endif
      case Control::kFocus:
        return &lc::controls::AfMode;
      case Control::kWhiteBalance:
        return &lc::controls::AwbEnable;
    }
    return nullptr;
  }

  const lc::ControlInfo* infoOf(const lc::ControlId* id) const {
    const auto found = camera_->controls().find(id);
    return found == camera_->controls().end() ? nullptr : &found->second;
  }

  void add(Control control, const AutomaticOr<double>& setting, lc::ControlList& controls) const {
    const bool isAutomatic = std::holds_alternative<Automatic>(setting);
    const lc::ControlId* const automatic = automaticControl(control);
    if (infoOf(automatic) != nullptr) {
      if (control == Control::kFocus) {
        controls.set(lc::controls::AfMode, isAutomatic
                                               ? std::int32_t{lc::controls::AfModeContinuous}
                                               : std::int32_t{lc::controls::AfModeManual});
#if PLEINAIR_LIBCAMERA_VERSION >= 500
      } else if (control == Control::kExposure) {
        controls.set(lc::controls::ExposureTimeMode, isAutomatic
                                                         ? lc::controls::ExposureTimeModeAuto
                                                         : lc::controls::ExposureTimeModeManual);
      } else if (control == Control::kGain) {
        controls.set(lc::controls::AnalogueGainMode, isAutomatic
                                                         ? lc::controls::AnalogueGainModeAuto
                                                         : lc::controls::AnalogueGainModeManual);
#endif
      } else {
        controls.set(automatic->id(), lc::ControlValue(isAutomatic));
      }
    }
    if (isAutomatic) return;
    const double value = std::get<double>(setting);
    const lc::ControlId* const id = valueControl(control);
    if (id->type() == lc::ControlTypeFloat) {
      controls.set(id->id(), lc::ControlValue(static_cast<float>(value)));
    } else {
      controls.set(id->id(), lc::ControlValue(static_cast<std::int32_t>(value)));
    }
  }

  std::shared_ptr<Manager> manager_;
  std::shared_ptr<lc::Camera> camera_;
  std::unique_ptr<lc::CameraConfiguration> configuration_;
};

class SystemLibrary final : public Library {
 public:
  Result<std::vector<FoundCamera>> list() override {
    const auto manager = Manager::shared();
    if (!manager) return tl::unexpected(manager.error());
    std::vector<FoundCamera> found;
    for (const auto& camera : (*manager)->cameras()) {
      found.push_back(
          {.id = camera->id(), .model = modelOf(*camera), .isUsb = endsInUsbIds(camera->id())});
    }
    return found;
  }

  Result<std::unique_ptr<Device>> open(const std::string& id) override {
    const auto manager = Manager::shared();
    if (!manager) return tl::unexpected(manager.error());
    std::shared_ptr<lc::Camera> camera = (*manager)->get(id);
    if (!camera) {
      return tl::unexpected(
          Error{.kind = ErrorKind::kNotFound,
                .problem = "is not there",
                .remedy = "`pleinair devices` lists those that are; check its cable"});
    }
    if (const int answer = camera->acquire(); answer < 0) {
      Error error = errnoError({}, "cannot be taken", -answer);
      if (answer == -EBUSY) error.remedy = "end the program that uses it";
      return tl::unexpected(std::move(error));
    }
    return std::make_unique<LibcameraDevice>(*manager, std::move(camera));
  }
};

}  // namespace

Library& systemLibrary() {
  static SystemLibrary library;
  return library;
}

bool hasSystemLibrary() {
  return true;
}

}  // namespace pleinair::hal::libcamera
