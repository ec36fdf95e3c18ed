#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "hal/cameras/aravis/library.h"
#include "hal/clock.h"

namespace pleinair::support {

/// The exceptional properties of one frame. Frames are numbered from 0 at each start.
struct FakeGigeFrame {
  std::uint64_t skipped = 0;  ///< frame numbers that are left out before this one
  std::uint64_t underruns = 0, missingPackets = 0, resentPackets = 0, ignoredPackets = 0;
  hal::aravis::BufferStatus status = hal::aravis::BufferStatus::kComplete;
  std::optional<std::uint32_t> pixelFormat;
  std::optional<hal::FrameSize> size;
  std::optional<std::size_t> usedBytes;
  std::optional<hal::Duration> age;
  std::optional<hal::Duration> chunkTime;
  std::vector<std::uint8_t> bytes;  ///< where empty, byte i of frame n is i + n
  bool isLost = false;              ///< the device is lost in place of this frame
};

/// A machine-vision camera as Aravis would present it. Time is the clock's: a wait for a frame
/// advances it.
struct FakeGigeCamera {
  std::string id = "Fake-Cam-1";
  std::string physicalId = "00:11:22:33:44:55";
  std::string address = "10.0.0.2";
  hal::aravis::Transport transport = hal::aravis::Transport::kGige;
  bool isController = true;
  std::vector<std::uint32_t> formats{0x01080001};
  hal::aravis::RegionBounds bounds{
      .width = {16, 128, 4}, .height = {2, 96, 2}, .xStep = 4, .yStep = 2};
  std::size_t padding = 0;     ///< bytes after each row
  std::size_t chunkBytes = 0;  ///< after the image
  std::optional<int> maxBinning = 4;
  double maxRate = 100;
  std::vector<std::string> triggers{"Line0", "Line1", "Software"};
  std::map<hal::aravis::Control, hal::aravis::Bounds<double>> ranges{
      {hal::aravis::Control::kExposure, {10, 100'000}}, {hal::aravis::Control::kGain, {0, 24}}};
  std::vector<hal::aravis::Control> automatic{hal::aravis::Control::kExposure};
  std::uint64_t firstId = 1;
  hal::Duration period = std::chrono::milliseconds(40);
  std::map<std::uint64_t, FakeGigeFrame> frames;
};

/// A library with fake cameras. One thread, but for the buffers that leases return.
class FakeAravis final : public hal::aravis::Library {
 public:
  explicit FakeAravis(hal::Clock& clock) : clock_(clock) {}

  void plug(FakeGigeCamera camera) { cameras_.push_back(std::move(camera)); }
  void unplugAll() { cameras_.clear(); }

  hal::Result<std::vector<hal::aravis::FoundDevice>> discover(bool gige, bool usb3) override;
  hal::Result<std::unique_ptr<hal::aravis::Device>> open(const std::string& name) override;
  std::size_t grantedSocketBuffer(std::size_t bytes) override {
    return std::min(bytes, mostSocketBytes);
  }
  bool mayUsePacketSocket() override { return hasPacketSocket; }

  std::size_t mostSocketBytes = 8 << 20;
  bool hasPacketSocket = false;

  // What cameras were told last.
  struct Told {
    std::uint32_t pixelFormat = 0;
    hal::aravis::Region region;
    int binning = 1;
    double rate = 0;
    std::string trigger;
    int triggers = 0;
    std::map<hal::aravis::Control, double> values;
    std::map<hal::aravis::Control, bool> automatic;
    int packetBytes = -1;
    bool chunks = false;
    hal::aravis::StreamSettings settings;
    std::size_t bufferBytes = 0;
    int open = 0;  ///< devices and streams that are open
  };
  Told told;

 private:
  hal::Clock& clock_;
  std::vector<FakeGigeCamera> cameras_;
};

}  // namespace pleinair::support
