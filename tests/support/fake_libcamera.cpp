#include "tests/support/fake_libcamera.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <deque>
#include <mutex>
#include <span>
#include <utility>

#include <sys/mman.h>
#include <unistd.h>

#include "hal/cameras/libcamera/frame_layout.h"
#include "hal/file_descriptor.h"

namespace pleinair::support {
namespace {

using namespace hal::libcamera;
using hal::Duration;
using hal::Error;
using hal::Result;

/// A buffer with the memory that its planes are in: of this process, or one behind the other in a
/// file that can be shared.
class OwnedMemory {
 public:
  OwnedMemory(const std::array<std::size_t, 3>& sizes, bool isShared) {
    std::size_t offset = 0;
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      view.offsets.at(i) = isShared ? offset : 0;
      offset += sizes.at(i);
    }
    if (isShared) {
      file_ = hal::FileDescriptor(memfd_create("sensor", MFD_CLOEXEC));
      if (ftruncate(file_.get(), static_cast<off_t>(offset)) != 0) std::abort();
      void* const address =
          mmap(nullptr, offset, PROT_READ | PROT_WRITE, MAP_SHARED, file_.get(), 0);
      if (address == MAP_FAILED) std::abort();
      mapped_ = {static_cast<std::uint8_t*>(address), offset};
    }
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      if (!isShared) own_.at(i).resize(sizes.at(i));
      bytes.at(i) = isShared ? mapped_.subspan(view.offsets.at(i), sizes.at(i))
                             : std::span<std::uint8_t>(own_.at(i));
      view.planes.at(i) = bytes.at(i);
      if (isShared) view.dmaBufs.at(i) = file_.get();
    }
  }
  ~OwnedMemory() {
    if (!mapped_.empty()) munmap(mapped_.data(), mapped_.size());
  }
  OwnedMemory(const OwnedMemory&) = delete;
  OwnedMemory& operator=(const OwnedMemory&) = delete;

  std::array<std::span<std::uint8_t>, 3> bytes;
  BufferMemory view;

 private:
  hal::FileDescriptor file_;
  std::span<std::uint8_t> mapped_;
  std::array<std::vector<std::uint8_t>, 3> own_;
};

class FakeStream final : public Stream {
 public:
  FakeStream(const FakeSensor& sensor, const StreamAnswer& answer, int buffers, int& open,
             hal::Clock& clock)
      : sensor_(sensor), open_(open), clock_(clock), due_(clock.now() + sensor.period) {
    ++open_;
    const StreamImage frame{
        .fourcc = answer.fourcc, .size = answer.size, .strideBytes = answer.strideBytes};
    for (int i = 0; i < buffers; ++i) {
      memory_.push_back(allocate(frame));
      if (answer.luma) luma_.push_back(allocate(*answer.luma));
      free_.push_back(static_cast<std::size_t>(i));
    }
  }
  ~FakeStream() override { --open_; }

  std::size_t bufferCount() const override { return memory_.size(); }
  std::shared_ptr<const BufferMemory> memory(std::size_t index) const override {
    return {memory_[index], &memory_[index]->view};
  }
  std::shared_ptr<const BufferMemory> lumaMemory(std::size_t index) const override {
    if (luma_.empty()) return nullptr;
    return {luma_[index], &luma_[index]->view};
  }

  std::optional<Completed> pop(Duration timeout) override {
    const hal::TimePoint until = clock_.now() + timeout;
    if (isLost_ || isSilent_ || due_ > until) {
      clock_.sleepUntil(until);
      return std::nullopt;
    }
    clock_.sleepUntil(due_);
    due_ += sensor_.period;
    FakeSensorFrame frame;
    if (sensor_.frames.contains(number_)) frame = sensor_.frames.at(number_);
    isLost_ = frame.isLost;
    isSilent_ = frame.isSilent;
    if (isLost_ || isSilent_) return std::nullopt;
    sequence_ += frame.skipped;
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) {
      ++sequence_;
      ++number_;
      return std::nullopt;
    }
    return fill(frame);
  }
  int push(std::size_t index) override {
    const std::scoped_lock lock(mutex_);
    if (sensor_.pushAnswer == 0) free_.push_back(index);
    return sensor_.pushAnswer;
  }
  bool isLost() const override { return isLost_; }

 private:
  std::shared_ptr<OwnedMemory> allocate(const StreamImage& answer) const {
    const FrameLayout& layout = *findLayout(answer.fourcc);
    const int planes = planeCount(layout.pixelFormat);
    std::array<std::size_t, 3> sizes{};
    for (int i = 0; i < planes; ++i) {
      const bool isHalf = i > 0 && layout.pixelFormat == hal::PixelFormat::kI420;
      sizes.at(static_cast<std::size_t>(i)) =
          (isHalf ? answer.strideBytes / 2 : answer.strideBytes) *
          static_cast<std::size_t>(planeRows(layout.pixelFormat, i, answer.size.height));
    }
    if (!sensor_.arePlanesSeparate) sizes = {sizes[0] + sizes[1] + sizes[2], 0, 0};
    sizes[0] -= std::min(sizes[0], sensor_.missingBytes);
    auto memory = std::make_shared<OwnedMemory>(sizes, sensor_.isShared);
    memory->view.planeCount = sensor_.arePlanesSeparate ? planes : 1;
    return memory;
  }

  Completed fill(const FakeSensorFrame& frame) {
    Completed completed;
    completed.index = free_.front();
    free_.pop_front();
    completed.isFaulty = frame.isFaulty;
    completed.sequence = sequence_++;
    completed.timestamp = frame.timestamp.value_or(clock_.now().time_since_epoch());
    completed.sensorTime = frame.sensorTime;
    completed.usedBytes = fill(*memory_[completed.index], 0, frame.missingBytes);
    if (!luma_.empty()) {
      completed.lumaUsedBytes = fill(*luma_[completed.index], 128, frame.missingLumaBytes);
    }
    ++number_;
    return completed;
  }

  std::array<std::size_t, 3> fill(OwnedMemory& memory, std::size_t first, std::size_t missing) {
    std::array<std::size_t, 3> used{};
    const auto last = static_cast<std::size_t>(memory.view.planeCount - 1);
    for (std::size_t plane = 0; plane <= last; ++plane)
      used.at(plane) = memory.bytes.at(plane).size();
    used.at(last) -= missing;
    for (std::size_t plane = 0; plane < 3; ++plane) {
      for (std::size_t i = 0; i < memory.bytes.at(plane).size(); ++i) {
        memory.bytes.at(plane)[i] = static_cast<std::uint8_t>(first + 16 * plane + i + number_);
      }
    }
    return used;
  }

  FakeSensor sensor_;
  int& open_;
  hal::Clock& clock_;
  hal::TimePoint due_;
  std::vector<std::shared_ptr<OwnedMemory>> memory_, luma_;
  std::mutex mutex_;  // guards the following
  std::deque<std::size_t> free_;
  std::uint64_t number_ = 0;
  std::uint32_t sequence_ = 3;  // drivers need not begin at 0
  bool isLost_ = false, isSilent_ = false;
};

class FakeDevice final : public Device {
 public:
  FakeDevice(FakeSensor sensor, FakeLibcamera::Told& told, hal::Clock& clock)
      : sensor_(std::move(sensor)), told_(told), clock_(clock) {
    ++told_.open;
  }
  ~FakeDevice() override { --told_.open; }

  std::string description() const override { return sensor_.model; }
  std::vector<OfferedFormat> formats() override { return sensor_.formats; }
  Result<StreamAnswer> configure(const StreamWish& wish) override {
    told_.wish = wish;
    ++told_.configured;
    answer_ = {.fourcc = wish.fourcc, .size = wish.size, .encoding = sensor_.encoding};
    const auto found = sensor_.adjusts.find({wish.size.width, wish.size.height});
    if (found != sensor_.adjusts.end()) answer_.size = found->second;
    const FrameLayout* const layout = findLayout(wish.fourcc);
    const auto width = static_cast<std::size_t>(answer_.size.width);
    answer_.strideBytes =
        sensor_.rowPadding + (layout->swappedBytes > 0
                                  ? width * static_cast<std::size_t>(layout->swappedBytes)
                                  : rowBytes(layout->pixelFormat, 0, answer_.size.width));
    answer_.isOrientationKept =
        sensor_.keepsOrientation || wish.orientation == Orientation::kUpright;
    if (wish.luma && sensor_.luma) {
      const hal::FrameSize size = sensor_.lumaSize.value_or(*wish.luma);
      answer_.luma =
          StreamImage{.fourcc = *sensor_.luma,
                      .size = size,
                      .strideBytes = static_cast<std::size_t>(size.width) + sensor_.rowPadding};
      if (sensor_.changesBesideLuma) --answer_.size.height;
    }
    return answer_;
  }
  std::optional<ControlRange> range(Control control) override {
    const auto found = sensor_.ranges.find(control);
    return found == sensor_.ranges.end() ? std::nullopt : std::optional(found->second);
  }
  bool hasAutomatic(Control control) override {
    return std::ranges::find(sensor_.automatic, control) != sensor_.automatic.end();
  }
  std::optional<std::array<Duration, 2>> periods() override { return sensor_.periods; }
  Result<std::unique_ptr<Stream>> start(const StartSettings& settings) override {
    told_.settings = settings;
    return std::make_unique<FakeStream>(sensor_, answer_, told_.wish.buffers, told_.open, clock_);
  }

 private:
  FakeSensor sensor_;
  FakeLibcamera::Told& told_;
  hal::Clock& clock_;
  StreamAnswer answer_;
};

}  // namespace

Result<std::vector<FoundCamera>> FakeLibcamera::list() {
  std::vector<FoundCamera> found;
  for (const FakeSensor& each : sensors_) {
    found.push_back({.id = each.id, .model = each.model, .isUsb = each.isUsb});
  }
  return found;
}

Result<std::unique_ptr<Device>> FakeLibcamera::open(const std::string& id) {
  const auto found = std::ranges::find(sensors_, id, &FakeSensor::id);
  if (found == sensors_.end()) {
    return tl::unexpected(Error{.kind = hal::ErrorKind::kNotFound, .problem = "is not there"});
  }
  if (found->isBusy) {
    return tl::unexpected(Error{.kind = hal::ErrorKind::kBusy, .problem = "cannot be taken"});
  }
  return std::make_unique<FakeDevice>(*found, told, clock_);
}

}  // namespace pleinair::support
