#include "tests/support/fake_aravis.h"

#include <algorithm>
#include <utility>

namespace pleinair::support {
namespace {

using namespace hal::aravis;
using hal::Duration;
using hal::Error;
using hal::Result;

class FakeStream final : public Stream {
 public:
  FakeStream(const FakeGigeCamera& camera, const FakeAravis::Told& told, int& open, bool& isLost,
             hal::Clock& clock, std::vector<std::span<std::uint8_t>> buffers)
      : camera_(camera),
        format_(told.pixelFormat),
        region_(told.region),
        open_(open),
        isLost_(isLost),
        clock_(clock),
        buffers_(std::move(buffers)),
        due_(clock.now() + camera.period) {
    ++open_;
    for (std::size_t i = 0; i < buffers_.size(); ++i) free_.push_back(i);
  }
  ~FakeStream() override { --open_; }

  std::optional<Filled> pop(Duration timeout) override {
    const hal::TimePoint until = clock_.now() + timeout;
    if (isLost_ || due_ > until) {
      clock_.sleepUntil(until);
      return std::nullopt;
    }
    clock_.sleepUntil(due_);
    due_ += camera_.period;
    const FakeGigeFrame frame =
        camera_.frames.contains(number_) ? camera_.frames.at(number_) : FakeGigeFrame{};
    if (frame.isLost) {
      isLost_ = true;
      return std::nullopt;
    }
    counts_.underruns += frame.underruns;
    counts_.missingPackets += frame.missingPackets;
    counts_.resentPackets += frame.resentPackets;
    counts_.ignoredPackets += frame.ignoredPackets;
    if (free_.empty()) {
      ++counts_.underruns;
      ++id_;
      ++number_;
      return std::nullopt;
    }
    return fill(frame);
  }
  void push(std::size_t index) override { free_.push_back(index); }
  StreamCounts counts() const override { return counts_; }

 private:
  Filled fill(const FakeGigeFrame& frame) {
    Filled filled{.index = free_.front(), .status = frame.status};
    free_.pop_front();
    id_ += frame.skipped;
    filled.frameId = (camera_.firstId + id_++ - 1) % 65535 + 1;
    if (camera_.firstId > 65535) filled.frameId = camera_.firstId + id_ - 1;
    const std::uint64_t number = number_++;
    filled.deviceTime = std::chrono::seconds(1) + number * camera_.period;
    filled.chunkTime = frame.chunkTime;
    filled.age = frame.age;
    filled.pixelFormat = frame.pixelFormat.value_or(format_);
    filled.size = frame.size.value_or(region_.size());
    filled.paddingBytes = camera_.padding;
    const std::span<std::uint8_t> buffer = buffers_[filled.index];
    filled.usedBytes = frame.usedBytes.value_or(buffer.size() - camera_.chunkBytes);
    for (std::size_t i = 0; i < buffer.size(); ++i) {
      buffer[i] = static_cast<std::uint8_t>(i + number);
    }
    std::ranges::copy(frame.bytes, buffer.begin());
    return filled;
  }

  FakeGigeCamera camera_;
  std::uint32_t format_;
  Region region_;
  int& open_;
  bool& isLost_;
  hal::Clock& clock_;
  std::vector<std::span<std::uint8_t>> buffers_;
  std::deque<std::size_t> free_;
  hal::TimePoint due_;
  std::uint64_t number_ = 0, id_ = 0;
  StreamCounts counts_;
};

class FakeDevice final : public Device {
 public:
  FakeDevice(FakeGigeCamera camera, FakeAravis::Told& told, hal::Clock& clock)
      : camera_(std::move(camera)), told_(told), clock_(clock) {
    told_ = {.open = told_.open + 1};
  }
  ~FakeDevice() override { --told_.open; }

  std::string description() const override { return "Fake Cam"; }
  Transport transport() const override { return camera_.transport; }
  bool isController() const override { return camera_.isController; }
  bool isLost() const override { return isLost_; }
  Result<std::vector<std::uint32_t>> pixelFormats() override { return camera_.formats; }
  Result<void> setPixelFormat(std::uint32_t pfnc) override {
    told_.pixelFormat = pfnc;
    return {};
  }
  std::optional<int> maxBinning() override { return camera_.maxBinning; }
  Result<void> setBinning(int factor) override {
    told_.binning = factor;
    return {};
  }
  Result<RegionBounds> regionBounds() override {
    RegionBounds bounds = camera_.bounds;
    bounds.width.max /= told_.binning;
    bounds.height.max /= told_.binning;
    return bounds;
  }
  Result<Region> setRegion(const Region& region) override { return told_.region = region; }
  Result<std::optional<double>> setFrameRate(double wanted) override {
    if (camera_.maxRate == 0) return std::nullopt;
    return std::optional(told_.rate = std::min(wanted, camera_.maxRate));
  }
  Result<std::vector<std::string>> triggerSources() override { return camera_.triggers; }
  Result<void> setTrigger(const std::string& source) override {
    told_.trigger = source;
    return {};
  }
  Result<void> trigger() override {
    ++told_.triggers;
    return {};
  }
  bool hasAutomatic(Control control) override {
    return std::ranges::find(camera_.automatic, control) != camera_.automatic.end();
  }
  Result<void> setAutomatic(Control control, bool isOn) override {
    told_.automatic[control] = isOn;
    return {};
  }
  std::optional<Bounds<double>> bounds(Control control) override {
    const auto found = camera_.ranges.find(control);
    return found == camera_.ranges.end() ? std::nullopt : std::optional(found->second);
  }
  Result<void> setValue(Control control, double value) override {
    told_.values[control] = value;
    return {};
  }
  Result<int> setPacketSize(int bytes) override {
    told_.packetBytes = bytes;
    return bytes == 0 ? 1500 : bytes;
  }
  bool enableChunkTimestamps() override { return told_.chunks = true; }
  Result<std::size_t> payloadBytes() override {
    const std::size_t bits = told_.pixelFormat >> 16 & 0xFF;
    const auto width = static_cast<std::size_t>(told_.region.width);
    const auto height = static_cast<std::size_t>(told_.region.height);
    if (camera_.padding == 0) return (width * height * bits + 7) / 8 + camera_.chunkBytes;
    return ((width * bits + 7) / 8 + camera_.padding) * height + camera_.chunkBytes;
  }
  Result<std::unique_ptr<Stream>> start(const StreamSettings& settings,
                                        std::vector<std::span<std::uint8_t>> buffers) override {
    told_.settings = settings;
    told_.bufferBytes = buffers.front().size();
    return std::make_unique<FakeStream>(camera_, told_, told_.open, isLost_, clock_,
                                        std::move(buffers));
  }

 private:
  FakeGigeCamera camera_;
  FakeAravis::Told& told_;
  hal::Clock& clock_;
  bool isLost_ = false;
};

}  // namespace

Result<std::vector<FoundDevice>> FakeAravis::discover(bool gige, bool usb3) {
  std::vector<FoundDevice> found;
  for (const FakeGigeCamera& each : cameras_) {
    if (!(each.transport == Transport::kGige ? gige : usb3)) continue;
    found.push_back({.id = each.id,
                     .physicalId = each.physicalId,
                     .address = each.address,
                     .vendor = "Fake",
                     .model = "Cam",
                     .serial = each.id.substr(each.id.rfind('-') + 1),
                     .transport = each.transport});
  }
  return found;
}

Result<std::unique_ptr<Device>> FakeAravis::open(const std::string& name) {
  for (const FakeGigeCamera& each : cameras_) {
    if (name != each.id && name != each.physicalId && name != each.address) continue;
    return std::make_unique<FakeDevice>(each, told, clock_);
  }
  return tl::unexpected(Error{.kind = hal::ErrorKind::kNotFound, .problem = "is not there"});
}

}  // namespace pleinair::support
