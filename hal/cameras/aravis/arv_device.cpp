#include "hal/cameras/aravis/arv_device.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "hal/cameras/aravis/arv_stream.h"

namespace pleinair::hal::aravis {
namespace {

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
    if (!buffers.empty()) stream->guard(buffers.front().size());
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

}  // namespace

std::unique_ptr<Device> arvDevice(Object<ArvCamera> camera) {
  return std::make_unique<ArvDeviceOfCamera>(std::move(camera));
}

}  // namespace pleinair::hal::aravis
