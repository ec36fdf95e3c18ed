#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/pixel_format.h"

// The seam to Aravis: all that the camera uses of it, without one of its types. Only
// aravis_library.cpp and arv_*.cpp call Aravis; tests replace the seam
// (tests/support/fake_aravis.h).

namespace pleinair::hal::aravis {

enum class Transport { kGige, kUsb3 };

/// A camera that discovery found.
struct FoundDevice {
  std::string id;          ///< maker, model and serial number: "Basler-acA1300-22334455"
  std::string physicalId;  ///< MAC address or USB GUID
  std::string address;     ///< IP address; empty for USB
  std::string vendor, model, serial;
  Transport transport = Transport::kGige;
};

template <class T>
struct Bounds {
  T min{};
  T max{};
  T step{1};
};

/// The part of the sensor that is read, in px after binning.
struct Region {
  int x = 0, y = 0, width = 0, height = 0;
  FrameSize size() const { return {width, height}; }
  friend bool operator==(const Region&, const Region&) = default;
};

struct RegionBounds {
  Bounds<int> width, height;
  /// Steps of the offsets; 0 where the device cannot move its region.
  int xStep = 0, yStep = 0;
};

/// Settings with a value and, in many devices, an automatic mode.
enum class Control { kExposure, kGain, kWhiteBalance };

/// What became of a buffer.
enum class BufferStatus {
  kComplete,
  kMissingPackets,  ///< packets were lost and could not be resent in time, or the frame broke off
  kSizeMismatch,    ///< the image did not fit into the buffer
  kAborted,         ///< given back empty because the stream ended
  kOther,           ///< the device sent something that is no image
};

/// A buffer that Aravis has filled.
struct Filled {
  std::size_t index = 0;
  BufferStatus status = BufferStatus::kComplete;
  std::uint64_t frameId = 0;
  Duration deviceTime{0};             ///< the device's clock; 0: unknown
  std::optional<Duration> chunkTime;  ///< the same, from the frame's chunk data
  std::optional<Duration> age;        ///< since its first packet arrived
  std::uint32_t pixelFormat = 0;      ///< PFNC code
  FrameSize size;                     ///< this and what follows: of complete frames only
  std::size_t paddingBytes = 0;       ///< after each row
  std::size_t offsetBytes = 0;        ///< where the pixels begin in the buffer
  std::size_t usedBytes = 0;          ///< bytes of pixels
};

/// Counts since the stream began. Those of packets are 0 for USB.
struct StreamCounts {
  std::uint64_t underruns = 0;  ///< frames for which there was no buffer
  std::uint64_t missingPackets = 0;
  std::uint64_t resentPackets = 0;   ///< lost at first, then received
  std::uint64_t ignoredPackets = 0;  ///< of no frame that was awaited
};

struct StreamSettings {
  bool resends = true;                ///< lost packets are asked for again
  Duration frameRetention{0};         ///< how long a frame is waited for after its last packet
  std::size_t socketBufferBytes = 0;  ///< fixed; 0: Aravis chooses
  /// Whether packets may be read below the UDP socket, whose buffer is then not used. It needs
  /// CAP_NET_RAW.
  bool usesPacketSocket = true;
};

/// A camera that streams. The destructor ends the stream; it may block for 7.5 s if the device no
/// longer answers.
class Stream {
 public:
  virtual ~Stream() = default;
  Stream() = default;
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Takes a filled buffer; nothing if none comes in time.
  virtual std::optional<Filled> pop(Duration timeout) = 0;
  /// Gives a buffer back to be filled. The one call that is allowed on any thread.
  virtual void push(std::size_t index) = 0;
  virtual StreamCounts counts() const = 0;
  /// Whether packets that no camera sends are kept from it.
  virtual bool isGuarded() const { return true; }
};

/// An open camera, of one thread. Any call may block for 3 s if the device no longer answers; the
/// destructor for longer. Errors: kDeviceLost (it does not answer), kUnsupported, kIo.
class Device {
 public:
  virtual ~Device() = default;
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual std::string description() const = 0;
  virtual Transport transport() const = 0;
  /// Whether this program may change settings. A GigE camera has one controller at a time; others
  /// may open it, but their writes fail.
  virtual bool isController() const = 0;
  /// Whether the device has not answered for some seconds, or was unplugged.
  virtual bool isLost() const = 0;

  virtual Result<std::vector<std::uint32_t>> pixelFormats() = 0;
  virtual Result<void> setPixelFormat(std::uint32_t pfnc) = 0;
  /// Nothing where the device cannot bin; else the largest factor.
  virtual std::optional<int> maxBinning() = 0;
  virtual Result<void> setBinning(int factor) = 0;
  virtual Result<RegionBounds> regionBounds() = 0;
  /// Sets a region and gives the one that is in force then.
  virtual Result<Region> setRegion(const Region& region) = 0;
  /// Sets the rate nearest to `wanted` and gives it; nothing where the device has no such setting.
  virtual Result<std::optional<double>> setFrameRate(double wanted) = 0;

  virtual Result<std::vector<std::string>> triggerSources() = 0;
  /// An empty source: free running.
  virtual Result<void> setTrigger(const std::string& source) = 0;
  virtual Result<void> trigger() = 0;

  virtual bool hasAutomatic(Control control) = 0;
  virtual Result<void> setAutomatic(Control control, bool isOn) = 0;
  /// Exposure in µs, gain in the device's units; nothing where the device has no such setting.
  virtual std::optional<Bounds<double>> bounds(Control control) = 0;
  virtual Result<void> setValue(Control control, double value) = 0;

  /// Bytes of a packet, headers included; 0: the largest that passes the network. GigE only.
  virtual Result<int> setPacketSize(int bytes) = 0;
  /// Whether frames bring their time in chunk data from now on.
  virtual bool enableChunkTimestamps() = 0;
  /// Bytes of a buffer for one frame.
  virtual Result<std::size_t> payloadBytes() = 0;
  /// Starts. The buffers outlive the stream, and all of them are its own until they are popped.
  virtual Result<std::unique_ptr<Stream>> start(const StreamSettings& settings,
                                                std::vector<std::span<std::uint8_t>> buffers) = 0;
};

/// Aravis. Any thread.
class Library {
 public:
  virtual ~Library() = default;
  Library() = default;
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

  /// Looks for cameras, on the network for 1 s.
  virtual Result<std::vector<FoundDevice>> discover(bool gige, bool usb3) = 0;
  /// Opens by FoundDevice::id, physical id or address. Errors: kNotFound, kBusy, kIo.
  virtual Result<std::unique_ptr<Device>> open(const std::string& name) = 0;
  /// The receive buffer that the system grants a socket which asks for so many bytes.
  virtual std::size_t grantedSocketBuffer(std::size_t bytes) = 0;
  /// Whether the process may read packets below UDP (CAP_NET_RAW).
  virtual bool mayUsePacketSocket() = 0;
};

/// The library of this build. Without libaravis, discover() finds nothing and open() answers
/// kUnsupported.
Library& systemLibrary();

}  // namespace pleinair::hal::aravis
