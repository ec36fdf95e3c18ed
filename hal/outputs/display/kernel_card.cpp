#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <mutex>
#include <system_error>
#include <type_traits>
#include <utility>

#include <drm_fourcc.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>
#include <xf86drm.h>
#include <xf86drmMode.h>

#include "hal/file_descriptor.h"
#include "hal/machine/local_time.h"
#include "hal/outputs/display/card.h"
#include "hal/outputs/display/gbm_buffers.h"

namespace pleinair::hal::display {
namespace {

template <auto kFree>
struct Freeing {
  template <class Held>
  void operator()(Held* held) const {
    kFree(held);
  }
};
template <class Held, auto kFree>
using Handle = std::unique_ptr<Held, Freeing<kFree>>;

using Resources = Handle<drmModeRes, drmModeFreeResources>;
using PlaneResources = Handle<drmModePlaneRes, drmModeFreePlaneResources>;
using ConnectorHandle = Handle<drmModeConnector, drmModeFreeConnector>;
using EncoderHandle = Handle<drmModeEncoder, drmModeFreeEncoder>;
using PlaneHandle = Handle<drmModePlane, drmModeFreePlane>;
using ObjectProperties = Handle<drmModeObjectProperties, drmModeFreeObjectProperties>;
using PropertyHandle = Handle<drmModePropertyRes, drmModeFreeProperty>;
using CrtcHandle = Handle<drmModeCrtc, drmModeFreeCrtc>;
using Request = Handle<drmModeAtomicReq, drmModeAtomicFree>;
using Version = Handle<drmVersion, drmFreeVersion>;
using PropertyBlob = Handle<drmModePropertyBlobRes, drmModeFreePropertyBlob>;

std::vector<Property> propertiesOf(int card, ObjectId object, std::uint32_t type) {
  std::vector<Property> properties;
  const ObjectProperties all(drmModeObjectGetProperties(card, object, type));
  for (std::uint32_t i = 0; all && i < all->count_props; ++i) {
    const PropertyHandle each(drmModeGetProperty(card, all->props[i]));
    if (!each) continue;
    properties.push_back(
        {static_cast<const char*>(each->name), each->prop_id, all->prop_values[i]});
  }
  return properties;
}

/// Total columns × total lines ÷ pixel clock (kHz); interlaced modes refresh twice in that time,
/// double-scanned ones take twice as long.
Duration periodOf(const drmModeModeInfo& mode) {
  if (mode.clock == 0) return std::chrono::microseconds(16'667);
  double pixels = static_cast<double>(mode.htotal) * mode.vtotal;
  if ((mode.flags & DRM_MODE_FLAG_INTERLACE) != 0) pixels /= 2.0;
  if ((mode.flags & DRM_MODE_FLAG_DBLSCAN) != 0) pixels *= 2.0;
  if (mode.vscan > 1) pixels *= mode.vscan;
  return fromMilliseconds(pixels / mode.clock);
}

Mode modeOf(const drmModeModeInfo& info) {
  Mode mode{.name = static_cast<const char*>(info.name),
            .size = {info.hdisplay, info.vdisplay},
            .period = periodOf(info),
            .isPreferred = (info.type & DRM_MODE_TYPE_PREFERRED) != 0,
            .isInterlaced = (info.flags & DRM_MODE_FLAG_INTERLACE) != 0,
            .timings = {}};
  static_assert(sizeof(info) == std::tuple_size_v<decltype(mode.timings)>);
  std::memcpy(mode.timings.data(), &info, sizeof(info));
  return mode;
}

std::string nameOf(const drmModeConnector& connector) {
  const char* type = drmModeGetConnectorTypeName(connector.connector_type);
  return std::string(type == nullptr ? "Unknown" : type) + "-" +
         std::to_string(connector.connector_type_id);
}

class KernelCard final : public Card {
 public:
  KernelCard(std::string node, FileDescriptor file)
      : node_(std::move(node)), file_(std::move(file)), gbm_(file_.get()) {
    const Version version(drmGetVersion(file_.get()));
    if (version) driver_ = version->name;
    std::uint64_t isMonotonic = 0;
    drmGetCap(file_.get(), DRM_CAP_TIMESTAMP_MONOTONIC, &isMonotonic);
    hasMonotonicTime_ = isMonotonic == 1;
  }

  const std::string& node() const override { return node_; }
  const std::string& driver() const override { return driver_; }

  Result<CardState> read(bool looksForDisplays) override {
    const Resources resources(drmModeGetResources(file_.get()));
    if (!resources) return tl::unexpected(lost("cannot list its displays"));
    CardState state;
    for (int i = 0; i < resources->count_crtcs; ++i) {
      const ObjectId id = resources->crtcs[i];
      state.crtcs.push_back({id, propertiesOf(file_.get(), id, DRM_MODE_OBJECT_CRTC)});
    }
    for (int i = 0; i < resources->count_connectors; ++i) {
      const ObjectId id = resources->connectors[i];
      const ConnectorHandle each(looksForDisplays ? drmModeGetConnector(file_.get(), id)
                                                  : drmModeGetConnectorCurrent(file_.get(), id));
      if (each) state.connectors.push_back(connectorOf(*each));
    }
    const PlaneResources planes(drmModeGetPlaneResources(file_.get()));
    for (std::uint32_t i = 0; planes && i < planes->count_planes; ++i) {
      const PlaneHandle each(drmModeGetPlane(file_.get(), planes->planes[i]));
      if (each) state.planes.push_back(planeOf(*each));
    }
    return state;
  }

  Answer isStillConnected(ObjectId connector, const Mode& mode) override {
    const ConnectorHandle current(drmModeGetConnectorCurrent(file_.get(), connector));
    if (!current) return tl::unexpected(lost("has lost its display"));
    const std::span modes(current->modes, static_cast<std::size_t>(current->count_modes));
    const auto isIt = [&](const drmModeModeInfo& each) {
      return modeOf(each).timings == mode.timings;
    };
    return current->connection == DRM_MODE_CONNECTED && std::ranges::any_of(modes, isIt);
  }

  std::optional<SavedCrtc> saveCrtc(ObjectId crtc) override {
    const CrtcHandle now(drmModeGetCrtc(file_.get(), crtc));
    if (!now || now->mode_valid == 0 || now->buffer_id == 0) return std::nullopt;
    SavedCrtc before{.crtc = crtc,
                     .framebuffer = now->buffer_id,
                     .x = static_cast<int>(now->x),
                     .y = static_cast<int>(now->y),
                     .connector = connectorOn(crtc),
                     .timings = modeOf(now->mode).timings};
    if (before.connector == 0) return std::nullopt;
    return before;
  }

  // By the older interface, which takes a mode instead of its blob: that of another program is gone
  // with the first modeset.
  void restore(const SavedCrtc& before) override {
    drmModeModeInfo mode{};
    std::memcpy(&mode, before.timings.data(), sizeof(mode));
    ObjectId connector = before.connector;
    drmModeSetCrtc(file_.get(), before.crtc, before.framebuffer,
                   static_cast<std::uint32_t>(before.x), static_cast<std::uint32_t>(before.y),
                   &connector, 1, &mode);
  }

  bool isMaster() override { return drmIsMaster(file_.get()) != 0; }
  int becomeMaster() override { return drmSetMaster(file_.get()) == 0 ? 0 : -errno; }
  void dropMaster() override { drmDropMaster(file_.get()); }

  int commit(std::span<const Change> changes, Commit kind) override {
    const Request request(drmModeAtomicAlloc());
    if (!request) return -ENOMEM;
    for (const Change& each : changes) {
      const int added =
          drmModeAtomicAddProperty(request.get(), each.object, each.property, each.value);
      if (added < 0) return added;
    }
    // libdrm's calls answer −errno here.
    return drmModeAtomicCommit(file_.get(), request.get(), flagsOf(kind), nullptr);
  }

  int createBlob(std::span<const std::uint8_t> bytes, ObjectId& blob) override {
    return drmModeCreatePropertyBlob(file_.get(), bytes.data(), bytes.size(), &blob);
  }
  void destroyBlob(ObjectId blob) override { drmModeDestroyPropertyBlob(file_.get(), blob); }

  int createBuffer(FrameSize size, ScanOutBuffer& buffer) override {
    drm_mode_create_dumb created{};
    created.width = static_cast<std::uint32_t>(size.width);
    created.height = static_cast<std::uint32_t>(size.height);
    created.bpp = 32;
    if (drmIoctl(file_.get(), DRM_IOCTL_MODE_CREATE_DUMB, &created) != 0) return -errno;
    ScanOutBuffer made;
    made.handle = created.handle;
    made.strideBytes = created.pitch;
    const int failed = finishBuffer(size, created.size, made);
    if (failed != 0) {
      destroyBuffer(made);
      return failed;
    }
    buffer = made;
    return 0;
  }

  void destroyBuffer(const ScanOutBuffer& buffer) override {
    if (buffer.framebuffer != 0) drmModeRmFB(file_.get(), buffer.framebuffer);
    if (!buffer.memory.empty()) ::munmap(buffer.memory.data(), buffer.memory.size());
    if (buffer.dmaBuf >= 0) systemCloser().close(buffer.dmaBuf);
    drm_mode_destroy_dumb destroyed{.handle = buffer.handle};
    drmIoctl(file_.get(), DRM_IOCTL_MODE_DESTROY_DUMB, &destroyed);
  }

  int createGpuBuffer(FrameSize size, std::span<const std::uint64_t> modifiers,
                      GpuBuffer& buffer) override {
    return gbm_.create(size, modifiers, buffer);
  }
  void destroyGpuBuffer(const GpuBuffer& buffer) override { gbm_.destroy(buffer); }
  int readGpuBuffer(const GpuBuffer& buffer, FrameSize size,
                    std::span<std::uint8_t> pixels) override {
    return gbm_.read(buffer, size, pixels);
  }

  std::optional<Vblank> lastVblank(ObjectId crtc) override {
    Vblank last;
    std::uint64_t time = 0;
    if (drmCrtcGetSequence(file_.get(), crtc, &last.sequence, &time) != 0) return std::nullopt;
    const bool isTimed = hasMonotonicTime_ && time != 0;  // 0: the driver does not know it
    last.time = isTimed ? TimePoint(std::chrono::nanoseconds(time)) : SteadyClock().now();
    return last;
  }

  bool hasVblank(ObjectId crtc) override {
    const bool isRead = drmCrtcGetSequence(file_.get(), crtc, nullptr, nullptr) == 0;
    return isRead || errno != EOPNOTSUPP;  // another error: the CRTC is off
  }

  int takeFlips(std::vector<FlipEvent>& flips) override {
    const std::scoped_lock lock(mutex_);
    pollfd ready{.fd = file_.get(), .events = POLLIN, .revents = 0};
    if (::poll(&ready, 1, 0) < 0) return errno == EINTR ? 0 : -errno;
    if ((ready.revents & (POLLERR | POLLHUP)) != 0) return -ENODEV;
    if ((ready.revents & POLLIN) == 0) return 0;
    alignas(drm_event_crtc_sequence) std::array<char, 1024> bytes;
    const ssize_t length = ::read(file_.get(), bytes.data(), bytes.size());
    if (length < 0) return errno == EINTR || errno == EAGAIN ? 0 : -errno;
    std::size_t at = 0;
    while (at + sizeof(drm_event) <= static_cast<std::size_t>(length)) {
      drm_event head{};
      std::memcpy(&head, bytes.data() + at, sizeof(head));
      if (head.type == DRM_EVENT_FLIP_COMPLETE && head.length >= sizeof(drm_event_vblank)) {
        drm_event_vblank flip{};
        std::memcpy(&flip, bytes.data() + at, sizeof(flip));
        flips.push_back(flipOf(flip));
      }
      at += std::max<std::size_t>(head.length, sizeof(drm_event));
    }
    return 0;
  }

 private:
  static std::uint32_t flagsOf(Commit kind) {
    switch (kind) {
      case Commit::kTest:
        return DRM_MODE_ATOMIC_TEST_ONLY | DRM_MODE_ATOMIC_ALLOW_MODESET;
      case Commit::kTestFlip:
        return DRM_MODE_ATOMIC_TEST_ONLY;
      case Commit::kModeset:
        return DRM_MODE_ATOMIC_ALLOW_MODESET;
      case Commit::kFlip:
        break;
    }
    return DRM_MODE_ATOMIC_NONBLOCK | DRM_MODE_PAGE_FLIP_EVENT;
  }

  FlipEvent flipOf(const drm_event_vblank& flip) const {
    const Duration time =
        std::chrono::seconds(flip.tv_sec) + std::chrono::microseconds(flip.tv_usec);
    return {.crtc = flip.crtc_id,
            .sequence = flip.sequence,
            .time = hasMonotonicTime_ ? TimePoint(time) : SteadyClock().now()};
  }

  /// Of a dumb buffer: its framebuffer, its memory and its descriptor.
  int finishBuffer(FrameSize size, std::uint64_t bytes, ScanOutBuffer& buffer) {
    const std::array<std::uint32_t, 4> handles{buffer.handle};
    const std::array<std::uint32_t, 4> strides{static_cast<std::uint32_t>(buffer.strideBytes)};
    const std::array<std::uint32_t, 4> offsets{};
    const int added =
        drmModeAddFB2(file_.get(), static_cast<std::uint32_t>(size.width),
                      static_cast<std::uint32_t>(size.height), DRM_FORMAT_XRGB8888, handles.data(),
                      strides.data(), offsets.data(), &buffer.framebuffer, 0);
    if (added != 0) return added;
    drm_mode_map_dumb map{};
    map.handle = buffer.handle;
    if (drmIoctl(file_.get(), DRM_IOCTL_MODE_MAP_DUMB, &map) != 0) return -errno;
    void* memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file_.get(),
                          static_cast<off_t>(map.offset));
    if (memory == MAP_FAILED) return -errno;
    buffer.memory = {static_cast<std::uint8_t*>(memory), static_cast<std::size_t>(bytes)};
    std::memset(memory, 0, bytes);
    int dmaBuf = -1;
    if (drmPrimeHandleToFD(file_.get(), buffer.handle, DRM_CLOEXEC | DRM_RDWR, &dmaBuf) == 0) {
      buffer.dmaBuf = dmaBuf;
    }
    return 0;
  }

  Connector connectorOf(const drmModeConnector& from) const {
    Connector connector{
        .id = from.connector_id,
        .name = nameOf(from),
        .isConnected = from.connection == DRM_MODE_CONNECTED && from.count_modes > 0,
        .modes = {},
        .crtcs = 0,
        .properties = propertiesOf(file_.get(), from.connector_id, DRM_MODE_OBJECT_CONNECTOR)};
    for (int i = 0; i < from.count_modes; ++i) connector.modes.push_back(modeOf(from.modes[i]));
    for (int i = 0; i < from.count_encoders; ++i) {
      const EncoderHandle encoder(drmModeGetEncoder(file_.get(), from.encoders[i]));
      if (encoder) connector.crtcs |= encoder->possible_crtcs;
    }
    return connector;
  }

  Plane planeOf(const drmModePlane& from) const {
    Plane plane{.id = from.plane_id,
                .isPrimary = false,
                .crtcs = from.possible_crtcs,
                .fourccs = {from.formats, from.formats + from.count_formats},
                .modifiers = {},
                .properties = propertiesOf(file_.get(), from.plane_id, DRM_MODE_OBJECT_PLANE)};
    const Property* type = find(plane.properties, "type");
    plane.isPrimary = type != nullptr && type->value == DRM_PLANE_TYPE_PRIMARY;
    if (const Property* layouts = find(plane.properties, "IN_FORMATS")) {
      const PropertyBlob blob(
          drmModeGetPropertyBlob(file_.get(), static_cast<std::uint32_t>(layouts->value)));
      if (blob) {
        plane.modifiers = modifiersIn({static_cast<const std::uint8_t*>(blob->data), blob->length},
                                      DRM_FORMAT_XRGB8888);
      }
    }
    return plane;
  }

  /// The connector that a CRTC drives; 0: none.
  ObjectId connectorOn(ObjectId crtc) const {
    const Resources resources(drmModeGetResources(file_.get()));
    for (int i = 0; resources && i < resources->count_connectors; ++i) {
      const ConnectorHandle each(drmModeGetConnectorCurrent(file_.get(), resources->connectors[i]));
      const EncoderHandle encoder(each && each->encoder_id != 0
                                      ? drmModeGetEncoder(file_.get(), each->encoder_id)
                                      : nullptr);
      if (encoder && encoder->crtc_id == crtc) return each->connector_id;
    }
    return 0;
  }

  Error lost(std::string problem) const {
    Error error = errnoError(node_, std::move(problem), errno);
    if (errno == ENODEV || errno == ENXIO) error.kind = ErrorKind::kDeviceLost;
    return error;
  }

  std::string node_;
  FileDescriptor file_;
  GbmBuffers gbm_;
  std::string driver_;
  bool hasMonotonicTime_ = true;
  std::mutex mutex_;  ///< of takeFlips()
};

/// Whether udev has not seen to a node yet: until then it belongs to root alone.
bool isUnseen(const std::string& node) {
  const std::filesystem::path database = "/run/udev/data";
  struct stat status {};
  std::error_code failure;
  if (::stat(node.c_str(), &status) != 0 || !std::filesystem::exists(database, failure)) {
    return false;
  }
  const std::string entry =
      "c" + std::to_string(major(status.st_rdev)) + ":" + std::to_string(minor(status.st_rdev));
  return !std::filesystem::exists(database / entry, failure);
}

class KernelCards final : public Cards {
 public:
  std::vector<std::string> nodes() override {
    std::vector<std::string> nodes;
    std::error_code failure;
    for (std::filesystem::directory_iterator each("/dev/dri", failure), end;
         !failure && each != end; each.increment(failure)) {
      if (each->path().filename().string().starts_with("card")) {
        nodes.push_back(each->path().string());
      }
    }
    std::ranges::sort(nodes);
    return nodes;
  }

  Result<std::unique_ptr<Card>> open(const std::string& node) override {
    FileDescriptor file(::open(node.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK));
    if (!file) {
      const int problem = errno;
      if (problem == EACCES && isUnseen(node)) {
        return tl::unexpected(Error{.kind = ErrorKind::kBusy,
                                    .subject = node,
                                    .problem = "has just come: udev has not seen to it yet"});
      }
      return tl::unexpected(errnoError(node, "cannot open", problem,
                                       problem == EACCES ? "add yourself to the group video" : ""));
    }
    // A card without displays (a GPU that only renders) has no such capability.
    if (drmSetClientCap(file.get(), DRM_CLIENT_CAP_UNIVERSAL_PLANES, 1) != 0 ||
        drmSetClientCap(file.get(), DRM_CLIENT_CAP_ATOMIC, 1) != 0) {
      return tl::unexpected(Error{.kind = ErrorKind::kUnsupported,
                                  .subject = node,
                                  .problem = "shows no pictures by atomic commits",
                                  .remedy = "its driver is too old, or it has no displays"});
    }
    return std::make_unique<KernelCard>(node, std::move(file));
  }

  std::optional<Duration> timeOfDay() override { return localTimeOfDay(); }

  Duration timeSuspended() override {
    timespec with{};
    timespec without{};
    ::clock_gettime(CLOCK_MONOTONIC, &without);
    ::clock_gettime(CLOCK_BOOTTIME, &with);
    return std::chrono::seconds(with.tv_sec - without.tv_sec) +
           std::chrono::nanoseconds(with.tv_nsec - without.tv_nsec);
  }
};

}  // namespace

const Property* find(std::span<const Property> properties, std::string_view name) {
  const auto found = std::ranges::find(properties, name, &Property::name);
  return found == properties.end() ? nullptr : &*found;
}

Cards& kernelCards() {
  static KernelCards cards;
  return cards;
}

}  // namespace pleinair::hal::display
