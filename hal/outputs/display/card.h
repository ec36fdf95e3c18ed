#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/pixel_format.h"
#include "hal/surface.h"

namespace pleinair::hal::display {

/// A connector, CRTC, plane, property, framebuffer or blob of a card. 0: none.
using ObjectId = std::uint32_t;

/// A property of an object, with its value when the card was read.
struct Property {
  std::string name;  ///< "CRTC_ID", "MODE_ID", "FB_ID" …
  ObjectId id = 0;
  std::uint64_t value = 0;
};

/// The property of that name; null where the object has none.
const Property* find(std::span<const Property> properties, std::string_view name);

/// A mode of a display.
struct Mode {
  std::string name;  ///< "1920x1080"
  FrameSize size;
  Duration period{0};  ///< between refreshes: total lines × total columns ÷ pixel clock
  bool isPreferred = false;
  bool isInterlaced = false;
  /// struct drm_mode_modeinfo, as MODE_ID takes it.
  std::array<std::uint8_t, 68> timings{};
};

/// A connector of a card, with the display that is plugged into it.
struct Connector {
  ObjectId id = 0;
  std::string name;  ///< as the kernel writes it: "HDMI-A-1"
  bool isConnected = false;
  std::vector<Mode> modes;  ///< the display's, best first
  std::uint32_t crtcs = 0;  ///< a bit for each CRTC, by index, that can drive it
  std::vector<Property> properties;
};

struct Crtc {
  ObjectId id = 0;
  std::vector<Property> properties;
};

struct Plane {
  ObjectId id = 0;
  bool isPrimary = false;
  std::uint32_t crtcs = 0;  ///< a bit for each CRTC, by index, that can show it
  std::vector<std::uint32_t> fourccs;
  /// The layouts of XRGB8888 that it scans out (modifiers of drm_fourcc.h); empty where its driver
  /// names none.
  std::vector<std::uint64_t> modifiers;
  std::vector<Property> properties;
};

/// The connectors, CRTCs and planes of a card, in its own order, which bits of masks refer to.
struct CardState {
  std::vector<Connector> connectors;
  std::vector<Crtc> crtcs;
  std::vector<Plane> planes;
};

/// A property that a commit changes.
struct Change {
  ObjectId object = 0;
  ObjectId property = 0;
  std::uint64_t value = 0;
};

enum class Commit {
  kTest,      ///< only asks whether the card would take it, a modeset included
  kTestFlip,  ///< only asks whether the card would take it without a modeset
  kModeset,   ///< may change modes; returns when it is done
  kFlip,      ///< returns at once; a FlipEvent follows
};

/// A flip that took place.
struct FlipEvent {
  ObjectId crtc = 0;
  std::uint32_t sequence = 0;  ///< of the refresh; 0 where the driver has no vblank
  TimePoint time;
};

/// A vertical blanking of a CRTC: the instant of a refresh.
struct Vblank {
  std::uint64_t sequence = 0;  ///< how many there were
  TimePoint time;
};

/// Memory that a CRTC can scan out, which the processor writes ("dumb" buffer): rows of 4-byte
/// pixels.
struct ScanOutBuffer {
  ObjectId framebuffer = 0;
  std::uint32_t handle = 0;
  int dmaBuf = -1;  ///< −1 where the driver does not export it; closed with the buffer
  std::span<std::uint8_t> memory;
  std::size_t strideBytes = 0;
};

/// Memory that a CRTC can scan out and that a GPU draws into, XRGB8888 in a layout of its driver's.
struct GpuBuffer {
  ObjectId framebuffer = 0;
  std::uint64_t modifier = kLinearModifier;
  int planeCount = 1;
  std::array<SurfacePlane, 4> planes;  ///< their descriptors are closed with the buffer
  void* allocation = nullptr;          ///< the card's own
};

/// A CRTC's framebuffer, mode and connector before an output claimed it.
struct SavedCrtc {
  ObjectId crtc = 0;
  ObjectId framebuffer = 0;
  int x = 0;
  int y = 0;
  ObjectId connector = 0;
  std::array<std::uint8_t, 68> timings{};  ///< of the mode
};

/// The kernel's interface to a graphics card (DRM/KMS, atomic): behind it a kernel's card, or a
/// test's. Calls answer 0, or −errno where they fail. Thread-safe.
class Card {
 public:
  virtual ~Card() = default;
  Card() = default;
  Card(const Card&) = delete;
  Card& operator=(const Card&) = delete;

  virtual const std::string& node() const = 0;    ///< "/dev/dri/card0"
  virtual const std::string& driver() const = 0;  ///< "virtio_gpu"

  /// Reads what the card has. `looksForDisplays`: asks the displays, which takes up to some 100 ms;
  /// otherwise what is known of them. Errors: kDeviceLost, kUnsupported (no modes), kIo.
  virtual Result<CardState> read(bool looksForDisplays) = 0;

  /// Whether a display is plugged into the connector, with this mode, as far as is known without
  /// asking it. Errors: kDeviceLost.
  virtual Answer isStillConnected(ObjectId connector, const Mode& mode) = 0;

  /// A CRTC's state, for restore(); unset if the CRTC is off.
  virtual std::optional<SavedCrtc> saveCrtc(ObjectId crtc) = 0;
  virtual void restore(const SavedCrtc& before) = 0;

  /// Only the master may commit. Another program's may become it once this one has dropped it.
  virtual bool isMaster() = 0;
  virtual int becomeMaster() = 0;
  virtual void dropMaster() = 0;

  /// EBUSY: a flip of the same CRTC is pending. EACCES: not the master.
  virtual int commit(std::span<const Change> changes, Commit kind) = 0;
  virtual int createBlob(std::span<const std::uint8_t> bytes, ObjectId& blob) = 0;
  virtual void destroyBlob(ObjectId blob) = 0;

  /// XRGB8888, black.
  virtual int createBuffer(FrameSize size, ScanOutBuffer& buffer) = 0;
  virtual void destroyBuffer(const ScanOutBuffer& buffer) = 0;

  /// A buffer for a GPU, in the best of these layouts; undefined content. The first call may take
  /// some 100 ms, for a driver to be loaded. ENOSYS: there is none.
  virtual int createGpuBuffer(FrameSize size, std::span<const std::uint64_t> modifiers,
                              GpuBuffer& buffer) = 0;
  virtual void destroyGpuBuffer(const GpuBuffer& buffer) = 0;
  /// Copies what lies in it into `pixels`, as the display would show it: packed rows of bytes
  /// B, G, R, X. Waits for the GPU; slow.
  virtual int readGpuBuffer(const GpuBuffer& buffer, FrameSize size,
                            std::span<std::uint8_t> pixels) = 0;

  /// The last vertical blanking of a CRTC that is on; nothing where its driver has none, and flips
  /// take place at once.
  virtual std::optional<Vblank> lastVblank(ObjectId crtc) = 0;
  /// Whether its driver counts a CRTC's refreshes, which may be off.
  virtual bool hasVblank(ObjectId crtc) = 0;
  /// Appends the flips since the last call, of all CRTCs. Never waits.
  virtual int takeFlips(std::vector<FlipEvent>& flips) = 0;
};

/// Opens cards; tests replace it with fakes.
class Cards {
 public:
  virtual ~Cards() = default;
  Cards() = default;
  Cards(const Cards&) = delete;
  Cards& operator=(const Cards&) = delete;

  /// The nodes of the cards that are there, sorted: "/dev/dri/card0".
  virtual std::vector<std::string> nodes() = 0;
  /// Errors: kPermissionDenied, kBusy (udev has not seen to the node yet), kNotFound, kUnsupported
  /// (it cannot show pictures, or not by atomic commits), kIo.
  virtual Result<std::unique_ptr<Card>> open(const std::string& node) = 0;

  // What displays ask of the machine besides. Any thread.

  /// Local time, since midnight; nothing while the machine's clock cannot be right.
  virtual std::optional<Duration> timeOfDay() = 0;
  /// How long the machine has been suspended since it was switched on.
  virtual Duration timeSuspended() = 0;

  /// Somebody was there, for all displays alike, also for one that is opened again.
  void noteActivity(TimePoint time) { lastActivity_ = time.time_since_epoch().count(); }
  /// When that was last; TimePoint{}: not yet.
  TimePoint lastActivity() const { return TimePoint(Duration(lastActivity_.load())); }

 private:
  std::atomic<Duration::rep> lastActivity_ = 0;
};

/// The kernel's.
Cards& kernelCards();

}  // namespace pleinair::hal::display
