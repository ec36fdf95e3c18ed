// The only file that calls Aravis (0.8).

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

#include <arv.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal/cameras/aravis/library.h"
#include "hal/file_descriptor.h"

namespace pleinair::hal::aravis {
namespace {

/// Frees what GLib and Aravis hand over.
struct FreeObject {
  void operator()(gpointer object) const { g_object_unref(object); }
};
struct FreeMemory {
  void operator()(gpointer memory) const { g_free(memory); }
};
template <class T>
using Object = std::unique_ptr<T, FreeObject>;
template <class T>
using Allocated = std::unique_ptr<T, FreeMemory>;

/// The error that a call reports through its last argument.
class GlibError {
 public:
  GlibError() = default;
  ~GlibError() { g_clear_error(&error_); }
  GlibError(const GlibError&) = delete;
  GlibError& operator=(const GlibError&) = delete;

  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  bool isSet() const { return error_ != nullptr; }
  Error as(std::string problem) const;

 private:
  GError* error_ = nullptr;
};

ErrorKind kindOf(const GError& error) {
  if (error.domain != ARV_DEVICE_ERROR) return ErrorKind::kIo;
  switch (error.code) {
    case ARV_DEVICE_ERROR_NOT_FOUND:
      return ErrorKind::kNotFound;
    case ARV_DEVICE_ERROR_NOT_CONTROLLER:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_ACCESS_DENIED:
    case ARV_DEVICE_ERROR_PROTOCOL_ERROR_BUSY:
      return ErrorKind::kBusy;
    case ARV_DEVICE_ERROR_NOT_CONNECTED:
    case ARV_DEVICE_ERROR_TIMEOUT:
      return ErrorKind::kDeviceLost;
    case ARV_DEVICE_ERROR_FEATURE_NOT_FOUND:
    case ARV_DEVICE_ERROR_WRONG_FEATURE:
    case ARV_DEVICE_ERROR_GENICAM_NOT_FOUND:
    case ARV_DEVICE_ERROR_NO_STREAM_CHANNEL:
      return ErrorKind::kUnsupported;
    default:
      return ErrorKind::kIo;
  }
}

Error GlibError::as(std::string problem) const {
  Error error{.kind = ErrorKind::kIo, .problem = std::move(problem)};
  if (error_ == nullptr) return error;
  error.kind = kindOf(*error_);
  error.problem += std::string(": ") + error_->message;
  if (error.kind == ErrorKind::kBusy) {
    error.remedy = "end the program that controls the camera";
  } else if (error.kind == ErrorKind::kDeviceLost) {
    error.remedy = "check its cable and its power";
  }
  return error;
}

std::string textOf(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

BufferStatus statusOf(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_SUCCESS:
      return BufferStatus::kComplete;
    case ARV_BUFFER_STATUS_TIMEOUT:
    case ARV_BUFFER_STATUS_MISSING_PACKETS:
      return BufferStatus::kMissingPackets;
    case ARV_BUFFER_STATUS_SIZE_MISMATCH:
      return BufferStatus::kSizeMismatch;
    case ARV_BUFFER_STATUS_ABORTED:
    case ARV_BUFFER_STATUS_CLEARED:
      return BufferStatus::kAborted;
    default:
      return BufferStatus::kOther;
  }
}

/// Reads the time of a frame from its chunk data, if the camera sends it there.
class ChunkTimes {
 public:
  /// Asks the camera for chunk data. Gives whether it sends the time in it.
  bool enable(ArvCamera* camera) {
    GlibError error;
    if (arv_camera_are_chunks_available(camera, error.out()) == 0 || error.isSet()) return false;
    arv_camera_set_chunks(camera, "Timestamp", error.out());
    if (error.isSet()) return false;
    parser_.reset(arv_camera_create_chunk_parser(camera));
    if (arv_camera_is_gv_device(camera) != 0) {
      const guint64 ticks = arv_gv_device_get_timestamp_tick_frequency(
          ARV_GV_DEVICE(arv_camera_get_device(camera)), error.out());
      if (!error.isSet() && ticks > 0) ticksPerSecond_ = static_cast<double>(ticks);
    }
    return parser_ != nullptr;
  }

  std::optional<Duration> of(ArvBuffer* buffer) const {
    if (!parser_ || arv_buffer_has_chunks(buffer) == 0) return std::nullopt;
    GlibError error;
    const gint64 ticks =
        arv_chunk_parser_get_integer_value(parser_.get(), buffer, "ChunkTimestamp", error.out());
    if (error.isSet() || ticks <= 0) return std::nullopt;
    const double nanoseconds = static_cast<double>(ticks) * (1e9 / ticksPerSecond_);
    if (nanoseconds > 9e18) return std::nullopt;
    return Duration(static_cast<std::int64_t>(nanoseconds));
  }

 private:
  Object<ArvChunkParser> parser_;
  double ticksPerSecond_ = 1e9;  ///< USB3 Vision counts nanoseconds
};

std::uint64_t infoOf(ArvStream* stream, const char* name) {
  for (guint i = 0; i < arv_stream_get_n_infos(stream); ++i) {
    if (std::string_view(arv_stream_get_info_name(stream, i)) == name) {
      return arv_stream_get_info_uint64(stream, i);
    }
  }
  return 0;  // USB counts no packets
}

class ArvStreamOfCamera final : public Stream {
 public:
  ArvStreamOfCamera(Object<ArvCamera> camera, Object<ArvStream> stream,
                    std::shared_ptr<const ChunkTimes> chunkTimes)
      : camera_(std::move(camera)),
        stream_(std::move(stream)),
        chunkTimes_(std::move(chunkTimes)) {}

  ~ArvStreamOfCamera() override {
    GlibError error;
    arv_camera_stop_acquisition(camera_.get(), error.out());  // fails if it is gone
  }

  void add(std::vector<std::span<std::uint8_t>> buffers) {
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      // The index is told apart from "no user data" by 1.
      buffers_.push_back(arv_buffer_new_full(buffers[i].size(), buffers[i].data(),
                                             GSIZE_TO_POINTER(i + 1), nullptr));
      handles_.emplace_back(buffers_.back());
      g_object_ref(buffers_.back());  // the stream takes a reference over with each push
      arv_stream_push_buffer(stream_.get(), buffers_.back());
    }
  }

  std::optional<Filled> pop(Duration timeout) override {
    const auto microseconds = std::chrono::duration_cast<std::chrono::microseconds>(timeout);
    ArvBuffer* const buffer = microseconds.count() <= 0
                                  ? arv_stream_try_pop_buffer(stream_.get())
                                  : arv_stream_timeout_pop_buffer(
                                        stream_.get(), static_cast<guint64>(microseconds.count()));
    if (buffer == nullptr) return std::nullopt;
    Filled filled = describe(buffer);
    g_object_unref(buffer);  // handles_ still has one
    return filled;
  }

  void push(std::size_t index) override {
    g_object_ref(buffers_[index]);
    arv_stream_push_buffer(stream_.get(), buffers_[index]);
  }

  StreamCounts counts() const override {
    StreamCounts counts;
    guint64 completed = 0, failures = 0, underruns = 0;
    arv_stream_get_statistics(stream_.get(), &completed, &failures, &underruns);
    counts.underruns = underruns;
    counts.missingPackets = infoOf(stream_.get(), "n_missing_packets");
    counts.resentPackets = infoOf(stream_.get(), "n_resent_packets");
    counts.ignoredPackets = infoOf(stream_.get(), "n_ignored_packets");
    return counts;
  }

 private:
  Filled describe(ArvBuffer* buffer) const {
    Filled filled;
    const gsize tag = GPOINTER_TO_SIZE(arv_buffer_get_user_data(buffer));
    filled.index = tag - 1;
    filled.status = statusOf(arv_buffer_get_status(buffer));
    if (filled.status == BufferStatus::kAborted) return filled;
    filled.frameId = arv_buffer_get_frame_id(buffer);
    filled.deviceTime = Duration(
        static_cast<std::int64_t>(std::min<guint64>(arv_buffer_get_timestamp(buffer), G_MAXINT64)));
    const auto system = static_cast<std::int64_t>(
        std::min<guint64>(arv_buffer_get_system_timestamp(buffer), G_MAXINT64));
    if (system > 0) filled.age = Duration(g_get_real_time() * 1000 - system);
    // Of a frame that is not complete, even the packet that describes it may be lost.
    if (filled.status != BufferStatus::kComplete) return filled;
    describeImage(buffer, filled);
    if (chunkTimes_) filled.chunkTime = chunkTimes_->of(buffer);
    return filled;
  }

  /// Aravis asserts that there is an image where one is asked for.
  static void describeImage(ArvBuffer* buffer, Filled& filled) {
    const ArvBufferPayloadType type = arv_buffer_get_payload_type(buffer);
    const bool isImage = type == ARV_BUFFER_PAYLOAD_TYPE_IMAGE ||
                         type == ARV_BUFFER_PAYLOAD_TYPE_EXTENDED_CHUNK_DATA;
    if (!isImage) {
      filled.status = BufferStatus::kOther;
      return;
    }
    filled.pixelFormat = arv_buffer_get_image_pixel_format(buffer);
    filled.size = {arv_buffer_get_image_width(buffer), arv_buffer_get_image_height(buffer)};
    gint paddingX = 0, paddingY = 0;
    arv_buffer_get_image_padding(buffer, &paddingX, &paddingY);
    filled.paddingBytes = static_cast<std::size_t>(std::max(paddingX, 0));
    size_t allBytes = 0, imageBytes = 0;
    const auto* const all =
        static_cast<const std::uint8_t*>(arv_buffer_get_data(buffer, &allBytes));
    const auto* const image =
        static_cast<const std::uint8_t*>(arv_buffer_get_image_data(buffer, &imageBytes));
    if (image == nullptr || all == nullptr || image < all) return;
    filled.offsetBytes = static_cast<std::size_t>(image - all);
    filled.usedBytes = imageBytes;
  }

  Object<ArvCamera> camera_;
  Object<ArvStream> stream_;
  std::shared_ptr<const ChunkTimes> chunkTimes_;
  std::vector<ArvBuffer*> buffers_;
  std::vector<Object<ArvBuffer>> handles_;
};

/// Names of a control's GenICam calls.
struct ControlCalls {
  gboolean (*isAvailable)(ArvCamera*, GError**);
  gboolean (*isAutoAvailable)(ArvCamera*, GError**);
  void (*setAuto)(ArvCamera*, ArvAuto, GError**);
  void (*bounds)(ArvCamera*, double*, double*, GError**);
  void (*set)(ArvCamera*, double, GError**);
};

gboolean isBalanceAutoAvailable(ArvCamera* camera, GError** error) {
  return arv_camera_is_feature_available(camera, "BalanceWhiteAuto", error);
}
void setBalanceAuto(ArvCamera* camera, ArvAuto mode, GError** error) {
  arv_camera_set_string(camera, "BalanceWhiteAuto", arv_auto_to_string(mode), error);
}

const ControlCalls& callsOf(Control control) {
  static constexpr std::array<ControlCalls, 3> kCalls{{
      {&arv_camera_is_exposure_time_available, &arv_camera_is_exposure_auto_available,
       &arv_camera_set_exposure_time_auto, &arv_camera_get_exposure_time_bounds,
       &arv_camera_set_exposure_time},
      {&arv_camera_is_gain_available, &arv_camera_is_gain_auto_available, &arv_camera_set_gain_auto,
       &arv_camera_get_gain_bounds, &arv_camera_set_gain},
      {nullptr, &isBalanceAutoAvailable, &setBalanceAuto, nullptr, nullptr},
  }};
  return kCalls.at(static_cast<std::size_t>(control));
}

class ArvDeviceOfCamera final : public Device {
 public:
  explicit ArvDeviceOfCamera(Object<ArvCamera> camera) : camera_(std::move(camera)) {
    arv_camera_set_range_check_policy(camera_.get(), ARV_RANGE_CHECK_POLICY_ENABLE);
    // The handler shares the flag: it may run on the heartbeat thread while it is disconnected.
    lostHandler_ = g_signal_connect_data(
        device(), "control-lost", G_CALLBACK(&noteLoss), new Flag(isLost_),
        [](gpointer flag, GClosure*) { delete static_cast<Flag*>(flag); }, GConnectFlags(0));
  }
  ~ArvDeviceOfCamera() override { g_signal_handler_disconnect(device(), lostHandler_); }

  std::string description() const override {
    GlibError error;
    const std::string vendor = textOf(arv_camera_get_vendor_name(camera_.get(), error.out()));
    const std::string model = textOf(arv_camera_get_model_name(camera_.get(), error.out()));
    return vendor.empty() ? model : vendor + " " + model;
  }
  Transport transport() const override {
    return arv_camera_is_gv_device(camera_.get()) != 0 ? Transport::kGige : Transport::kUsb3;
  }
  bool isController() const override {
    return transport() != Transport::kGige ||
           arv_gv_device_is_controller(ARV_GV_DEVICE(device())) != 0;
  }
  bool isLost() const override { return *isLost_; }

  Result<std::vector<std::uint32_t>> pixelFormats() override {
    GlibError error;
    guint count = 0;
    const Allocated<gint64> codes(
        arv_camera_dup_available_pixel_formats(camera_.get(), &count, error.out()));
    if (error.isSet()) return tl::unexpected(error.as("cannot list its pixel formats"));
    std::vector<std::uint32_t> formats;
    for (guint i = 0; i < count; ++i) {
      formats.push_back(static_cast<std::uint32_t>(codes.get()[i]));
    }
    return formats;
  }
  Result<void> setPixelFormat(std::uint32_t pfnc) override {
    return did("cannot set its pixel format",
               [&](GError** error) { arv_camera_set_pixel_format(camera_.get(), pfnc, error); });
  }

  std::optional<int> maxBinning() override {
    GlibError error;
    if (arv_camera_is_binning_available(camera_.get(), error.out()) == 0) return std::nullopt;
    gint min = 1, maxX = 1, maxY = 1;
    arv_camera_get_x_binning_bounds(camera_.get(), &min, &maxX, error.out());
    if (!error.isSet()) {
      arv_camera_get_y_binning_bounds(camera_.get(), &min, &maxY, error.out());
    }
    if (error.isSet()) return std::nullopt;
    return std::min(maxX, maxY);
  }
  Result<void> setBinning(int factor) override {
    return did("cannot set its binning", [&](GError** error) {
      arv_camera_set_binning(camera_.get(), factor, factor, error);
    });
  }

  Result<RegionBounds> regionBounds() override {
    RegionBounds bounds;
    GlibError error;
    // Offsets limit what the sizes may be.
    if (arv_camera_is_region_offset_available(camera_.get(), error.out()) != 0) {
      gint x = 0, y = 0, width = 0, height = 0;
      arv_camera_get_region(camera_.get(), &x, &y, &width, &height, error.out());
      if (!error.isSet()) {
        arv_camera_set_region(camera_.get(), 0, 0, width, height, error.out());
      }
      bounds.xStep = std::max(arv_camera_get_x_offset_increment(camera_.get(), nullptr), 1);
      bounds.yStep = std::max(arv_camera_get_y_offset_increment(camera_.get(), nullptr), 1);
    }
    if (!error.isSet()) {
      arv_camera_get_width_bounds(camera_.get(), &bounds.width.min, &bounds.width.max, error.out());
    }
    if (!error.isSet()) {
      arv_camera_get_height_bounds(camera_.get(), &bounds.height.min, &bounds.height.max,
                                   error.out());
    }
    if (error.isSet()) return tl::unexpected(error.as("cannot tell its sizes"));
    bounds.width.step = std::max(arv_camera_get_width_increment(camera_.get(), nullptr), 1);
    bounds.height.step = std::max(arv_camera_get_height_increment(camera_.get(), nullptr), 1);
    return bounds;
  }
  Result<Region> setRegion(const Region& region) override {
    GlibError error;
    arv_camera_set_region(camera_.get(), region.x, region.y, region.width, region.height,
                          error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot set its region"));
    Region set;
    arv_camera_get_region(camera_.get(), &set.x, &set.y, &set.width, &set.height, error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot tell its region"));
    return set;
  }

  Result<std::optional<double>> setFrameRate(double wanted) override {
    GlibError error;
    if (arv_camera_is_frame_rate_available(camera_.get(), error.out()) == 0) return std::nullopt;
    double min = 0, max = 0;
    arv_camera_get_frame_rate_bounds(camera_.get(), &min, &max, error.out());
    if (!error.isSet()) {
      arv_camera_set_frame_rate(camera_.get(), std::clamp(wanted, min, std::max(min, max)),
                                error.out());
    }
    if (error.isSet()) return tl::unexpected(error.as("cannot set its frame rate"));
    const double rate = arv_camera_get_frame_rate(camera_.get(), error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot tell its frame rate"));
    return std::optional(rate);
  }

  Result<std::vector<std::string>> triggerSources() override {
    GlibError error;
    guint count = 0;
    const Allocated<const char*> names(
        arv_camera_dup_available_trigger_sources(camera_.get(), &count, error.out()));
    if (error.isSet()) return tl::unexpected(error.as("cannot list its triggers"));
    return std::vector<std::string>(names.get(), names.get() + count);
  }
  Result<void> setTrigger(const std::string& source) override {
    GlibError error;
    arv_camera_set_acquisition_mode(camera_.get(), ARV_ACQUISITION_MODE_CONTINUOUS, error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot set its acquisition mode"));
    if (!source.empty()) {
      return did("cannot set its trigger",
                 [&](GError** out) { arv_camera_set_trigger(camera_.get(), source.c_str(), out); });
    }
    arv_camera_clear_triggers(camera_.get(), error.out());  // some have none to clear
    return {};
  }
  Result<void> trigger() override {
    return did("cannot be triggered",
               [&](GError** error) { arv_camera_software_trigger(camera_.get(), error); });
  }

  bool hasAutomatic(Control control) override {
    GlibError error;
    const gboolean has = callsOf(control).isAutoAvailable(camera_.get(), error.out());
    return has != 0 && !error.isSet();
  }
  Result<void> setAutomatic(Control control, bool isOn) override {
    return did("cannot set an automatic control", [&](GError** error) {
      callsOf(control).setAuto(camera_.get(), isOn ? ARV_AUTO_CONTINUOUS : ARV_AUTO_OFF, error);
    });
  }
  std::optional<Bounds<double>> bounds(Control control) override {
    const ControlCalls& calls = callsOf(control);
    GlibError error;
    if (calls.bounds == nullptr || calls.isAvailable(camera_.get(), error.out()) == 0) {
      return std::nullopt;
    }
    Bounds<double> bounds;
    calls.bounds(camera_.get(), &bounds.min, &bounds.max, error.out());
    if (error.isSet() || !(bounds.min <= bounds.max)) return std::nullopt;
    return bounds;
  }
  Result<void> setValue(Control control, double value) override {
    return did("cannot set a control",
               [&](GError** error) { callsOf(control).set(camera_.get(), value, error); });
  }

  Result<int> setPacketSize(int bytes) override {
    GlibError error;
    if (bytes == 0) {
      // Where test packets do not come through, the camera keeps its own size.
      arv_camera_gv_auto_packet_size(camera_.get(), error.out());
    } else {
      arv_camera_gv_set_packet_size(camera_.get(), bytes, error.out());
      if (error.isSet()) return tl::unexpected(error.as("cannot set its packet size"));
    }
    const guint size = arv_camera_gv_get_packet_size(camera_.get(), error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot tell its packet size"));
    return static_cast<int>(size);
  }
  bool enableChunkTimestamps() override {
    auto times = std::make_shared<ChunkTimes>();
    if (!times->enable(camera_.get())) return false;
    chunkTimes_ = std::move(times);
    return true;
  }
  Result<std::size_t> payloadBytes() override {
    GlibError error;
    const guint bytes = arv_camera_get_payload(camera_.get(), error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot tell the size of its frames"));
    return bytes;
  }

  Result<std::unique_ptr<Stream>> start(const StreamSettings& settings,
                                        std::vector<std::span<std::uint8_t>> buffers) override {
    if (transport() == Transport::kGige) {
      arv_camera_gv_set_stream_options(
          camera_.get(), settings.usesPacketSocket ? ARV_GV_STREAM_OPTION_NONE
                                                   : ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
    }
    GlibError error;
    Object<ArvStream> arvStream(
        arv_camera_create_stream(camera_.get(), nullptr, nullptr, error.out()));
    if (!arvStream) return tl::unexpected(error.as("cannot make a stream"));
    if (ARV_IS_GV_STREAM(arvStream.get())) configure(arvStream.get(), settings);
    auto stream = std::make_unique<ArvStreamOfCamera>(
        Object<ArvCamera>(ARV_CAMERA(g_object_ref(camera_.get()))), std::move(arvStream),
        chunkTimes_);
    stream->add(std::move(buffers));
    arv_camera_start_acquisition(camera_.get(), error.out());
    if (error.isSet()) return tl::unexpected(error.as("cannot start streaming"));
    return stream;
  }

 private:
  ArvDevice* device() const { return arv_camera_get_device(camera_.get()); }

  using Flag = std::shared_ptr<std::atomic<bool>>;

  static void noteLoss(ArvDevice*, gpointer flag) {
    **static_cast<Flag*>(flag) = true;  // on Aravis' heartbeat thread
  }

  static void configure(ArvStream* stream, const StreamSettings& settings) {
    const auto retention =
        std::chrono::duration_cast<std::chrono::microseconds>(settings.frameRetention);
    g_object_set(
        stream, "packet-resend",
        settings.resends ? ARV_GV_STREAM_PACKET_RESEND_ALWAYS : ARV_GV_STREAM_PACKET_RESEND_NEVER,
        "frame-retention", static_cast<guint>(retention.count()), nullptr);
    if (settings.socketBufferBytes == 0) {
      g_object_set(stream, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_AUTO, "socket-buffer-size",
                   0, nullptr);
      return;
    }
    g_object_set(stream, "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size",
                 static_cast<gint>(settings.socketBufferBytes), nullptr);
  }

  template <class Call>
  Result<void> did(const char* problem, Call call) {
    GlibError error;
    call(error.out());
    if (error.isSet()) return tl::unexpected(error.as(problem));
    return {};
  }

  Object<ArvCamera> camera_;
  Flag isLost_ = std::make_shared<std::atomic<bool>>(false);
  gulong lostHandler_ = 0;
  std::shared_ptr<const ChunkTimes> chunkTimes_;
};

void enableInterface(const char* name, bool isOn) {
  isOn ? arv_enable_interface(name) : arv_disable_interface(name);
}

class ArvLibrary final : public Library {
 public:
  Result<std::vector<FoundDevice>> discover(bool gige, bool usb3) override {
    const std::scoped_lock lock(mutex_);  // the list is Aravis' own, for all threads
    enableInterface("GigEVision", gige);
    enableInterface("USB3Vision", usb3);
    arv_update_device_list();
    std::vector<FoundDevice> devices;
    for (unsigned int i = 0; i < arv_get_n_devices(); ++i) {
      const std::string protocol = textOf(arv_get_device_protocol(i));
      if (protocol != "GigEVision" && protocol != "USB3Vision") continue;
      const bool isGige = protocol == "GigEVision";
      devices.push_back({.id = textOf(arv_get_device_id(i)),
                         .physicalId = textOf(arv_get_device_physical_id(i)),
                         .address = isGige ? textOf(arv_get_device_address(i)) : std::string(),
                         .vendor = textOf(arv_get_device_vendor(i)),
                         .model = textOf(arv_get_device_model(i)),
                         .serial = textOf(arv_get_device_serial_nbr(i)),
                         .transport = isGige ? Transport::kGige : Transport::kUsb3});
    }
    return devices;
  }

  Result<std::unique_ptr<Device>> open(const std::string& name) override {
    GlibError error;
    Object<ArvCamera> camera(arv_camera_new(name.c_str(), error.out()));
    if (camera) return std::make_unique<ArvDeviceOfCamera>(std::move(camera));
    Error failure = error.as("cannot be opened");
    if (failure.kind == ErrorKind::kNotFound) {
      failure.problem = "is not there";
      failure.remedy = "`pleinair devices` lists those that are; check its cable and its power";
    }
    return tl::unexpected(std::move(failure));
  }

  std::size_t grantedSocketBuffer(std::size_t bytes) override {
    const FileDescriptor socket(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    if (!socket) return 0;
    const int wanted = static_cast<int>(
        std::min<std::size_t>(bytes, static_cast<std::size_t>(std::numeric_limits<int>::max())));
    setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &wanted, sizeof wanted);
    int granted = 0;
    socklen_t length = sizeof granted;
    if (getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &granted, &length) != 0) return 0;
    return static_cast<std::size_t>(std::max(granted, 0)) / 2;  // socket(7): it tells twice as much
  }

  bool mayUsePacketSocket() override {
    return static_cast<bool>(FileDescriptor(::socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC, 0)));
  }

 private:
  std::mutex mutex_;
};

}  // namespace

Library& systemLibrary() {
  // Never destroyed: a driver thread that hangs in Aravis may outlive main().
  static ArvLibrary& library = *new ArvLibrary;
  return library;
}

}  // namespace pleinair::hal::aravis
