#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/camera.h"
#include "hal/clock.h"
#include "hal/error.h"
#include "hal/frame_image.h"
#include "hal/pixel_format.h"

// The seam to libcamera: all that the camera uses of it, without one of its types.
// libcamera_library.cpp (discovery) and lc_*.cpp (settings, stream) are the only files that call
// libcamera; tests replace the seam (tests/support/fake_libcamera.h).

namespace pleinair::hal::libcamera {

struct FoundCamera {
  std::string id;     ///< lasting: "/base/soc/i2c0mux/i2c@1/imx708@1a"
  std::string model;  ///< "imx708"; may be empty
  bool isUsb = false;
  /// What the library keeps of the listing while this is held, so that open() is quick; may be
  /// null.
  std::shared_ptr<const void> kept = nullptr;
};

struct OfferedFormat {
  std::uint32_t fourcc = 0;  ///< DRM's
  std::vector<FrameSize> sizes;
};

/// How the image is turned, from the way it is seen by the mounted sensor.
enum class Orientation { kUpright, kRotated180, kMirrored, kFlipped };

struct StreamWish {
  std::uint32_t fourcc = 0;
  FrameSize size;
  int buffers = 6;
  Orientation orientation = Orientation::kUpright;
  /// The size of a second image of each frame, whose first plane is luma; unset: none.
  std::optional<FrameSize> luma;
};

/// An image that libcamera makes of each frame, as it lies in memory.
struct StreamImage {
  std::uint32_t fourcc = 0;
  FrameSize size;
  std::size_t strideBytes = 0;
};

/// What libcamera made of a wish; any of it may differ.
struct StreamAnswer {
  std::uint32_t fourcc = 0;
  FrameSize size;
  std::size_t strideBytes = 0;
  ColorEncoding encoding;
  bool isOrientationKept = true;
  std::optional<StreamImage> luma;  ///< the second image; unset: there is none
};

/// Exposure in µs, gain as a factor, focus in dioptres, white balance in K.
enum class Control { kExposure, kGain, kFocus, kWhiteBalance };
inline constexpr std::array kControls{Control::kExposure, Control::kGain, Control::kFocus,
                                      Control::kWhiteBalance};

struct ControlRange {
  double min = 0, max = 0;
};

struct StartSettings {
  std::array<std::optional<AutomaticOr<double>>, kControls.size()> controls;
  std::optional<Duration> framePeriod;
};

/// A request that libcamera has completed.
struct Completed {
  std::size_t index = 0;
  bool isFaulty = false;     ///< the buffer is marked as wrong
  bool isCancelled = false;  ///< the stream ends
  std::uint32_t sequence = 0;
  Duration timestamp{0};               ///< on CLOCK_MONOTONIC; 0: unknown
  std::optional<Duration> sensorTime;  ///< when the first line was exposed, on CLOCK_BOOTTIME
  std::array<std::size_t, 3> usedBytes{};
  std::array<std::size_t, 3> lumaUsedBytes{};  ///< of the second image
};

/// The memory of a buffer, mapped for the CPU; valid while it is held.
struct BufferMemory {
  std::array<std::span<const std::uint8_t>, 3> planes;
  int planeCount = 0;
  std::array<int, 3> dmaBufs{-1, -1, -1};
  std::array<std::size_t, 3> offsets{};
  const ReadAccess* access = nullptr;  ///< brackets the reads of the mappings; null: none needed
};

/// A camera that streams. The destructor ends the stream; it may block for ever if a driver hangs.
class Stream {
 public:
  virtual ~Stream() = default;
  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  virtual std::size_t bufferCount() const = 0;
  /// Lives on after the stream.
  virtual std::shared_ptr<const BufferMemory> memory(std::size_t index) const = 0;
  /// The same of the request's second image; null where the stream has none.
  virtual std::shared_ptr<const BufferMemory> lumaMemory(std::size_t index) const = 0;
  /// Takes a completed request; nothing if none comes in time. The CPU may read its memory from
  /// then on until push(), within the memory's access.
  virtual std::optional<Completed> pop(Duration timeout) = 0;
  /// Queues the request again. 0 or −errno.
  virtual int push(std::size_t index) = 0;
  /// Whether libcamera has reported that the camera was unplugged. It does not always.
  virtual bool isLost() const = 0;
  /// Why, once it is lost.
  virtual std::string lossText() const { return "is unplugged, or its driver is gone"; }
};

/// An open camera, of one thread.
class Device {
 public:
  virtual ~Device() = default;
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual std::string description() const = 0;
  virtual std::vector<OfferedFormat> formats() = 0;
  /// Once or several times; the last counts. A second image that libcamera does not make is left
  /// out. Errors: kUnsupported, kIo.
  virtual Result<StreamAnswer> configure(const StreamWish& wish) = 0;
  virtual std::optional<ControlRange> range(Control control) = 0;
  virtual bool hasAutomatic(Control control) = 0;
  /// The frame periods that the configured camera can have.
  virtual std::optional<std::array<Duration, 2>> periods() = 0;
  /// Precondition: configured.
  virtual Result<std::unique_ptr<Stream>> start(const StartSettings& settings) = 0;
};

/// libcamera. Any thread.
class Library {
 public:
  virtual ~Library() = default;
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  virtual Result<std::vector<FoundCamera>> list() = 0;
  /// Errors: kNotFound, kBusy, kIo.
  virtual Result<std::unique_ptr<Device>> open(const std::string& id) = 0;
};

/// The library of this build, in this process. Without libcamera, list() finds nothing and open()
/// answers kUnsupported.
Library& systemLibrary();
/// Whether this build has libcamera.
bool hasSystemLibrary();

}  // namespace pleinair::hal::libcamera
