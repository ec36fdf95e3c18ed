#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/cameras/libcamera/library.h"
#include "hal/clock.h"

namespace pleinair::support {

/// The exceptional properties of one frame. Frames are numbered from 0 at each start.
struct FakeSensorFrame {
  std::uint32_t skipped = 0;  ///< frames that the driver loses before this one
  bool isFaulty = false;
  std::optional<hal::Duration> timestamp;
  std::optional<hal::Duration> sensorTime;
  std::size_t missingBytes = 0;      ///< of the last plane, which the driver has not filled
  std::size_t missingLumaBytes = 0;  ///< the same of the second image
  bool isLost = false;    ///< the camera is unplugged in place of this frame, and libcamera says so
  bool isSilent = false;  ///< from here on nothing comes, and nothing is said
};

/// A camera as libcamera would present it. Time is the clock's: a wait for a frame advances it.
struct FakeSensor {
  std::string id = "/base/i2c/imx708@1a";
  std::string model = "imx708";
  bool isUsb = false;
  bool isBusy = false;
  std::vector<hal::libcamera::OfferedFormat> formats{
      {.fourcc = 0x3231564E, .sizes = {{64, 48}, {128, 96}}}};  // NV12
  /// What libcamera makes of a size; unset: that size.
  std::map<std::pair<int, int>, hal::FrameSize> adjusts;
  std::size_t rowPadding = 0;
  bool arePlanesSeparate = false;
  bool isShared = false;  ///< buffers have descriptors, which other processes can map
  bool keepsOrientation = true;
  /// The layout of a second image, DRM's; unset: it makes none.
  std::optional<std::uint32_t> luma;
  std::optional<hal::FrameSize> lumaSize;  ///< whatever was asked for
  bool changesBesideLuma = false;          ///< its frames have a row less beside a second image
  std::size_t missingBytes = 0;            ///< by which buffers are too small
  hal::ColorEncoding encoding;
  std::map<hal::libcamera::Control, hal::libcamera::ControlRange> ranges;
  std::vector<hal::libcamera::Control> automatic;
  std::optional<std::array<hal::Duration, 2>> periods;
  hal::Duration period = std::chrono::milliseconds(40);
  int pushAnswer = 0;  ///< of each push()
  std::map<std::uint64_t, FakeSensorFrame> frames;
};

/// A library with fake cameras. Byte i of plane p of frame n is 16 p + i + n, and of its second
/// image 128 + 16 p + i + n. One thread; buffers may be given back on another.
class FakeLibcamera final : public hal::libcamera::Library {
 public:
  explicit FakeLibcamera(hal::Clock& clock) : clock_(clock) {}

  void plug(FakeSensor sensor) { sensors_.push_back(std::move(sensor)); }
  void unplugAll() { sensors_.clear(); }

  hal::Result<std::vector<hal::libcamera::FoundCamera>> list() override;
  hal::Result<std::unique_ptr<hal::libcamera::Device>> open(const std::string& id) override;

  /// What cameras were told last.
  struct Told {
    hal::libcamera::StreamWish wish;
    hal::libcamera::StartSettings settings;
    int open = 0;  ///< devices and streams that are open
    int configured = 0;
  };
  Told told;

 private:
  hal::Clock& clock_;
  std::vector<FakeSensor> sensors_;
};

}  // namespace pleinair::support
