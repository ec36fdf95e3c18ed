#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "hal/clock.h"
#include "hal/output.h"

namespace pleinair::support {

/// The properties and behaviour of a display; shared by the outputs that open it one after another.
struct FakeDisplay {
  hal::Duration period = std::chrono::nanoseconds(16'666'667);
  hal::TimePoint phase;  ///< one of its refreshes
  int surfaces = 3;
  std::uint32_t fourcc = hal::kXrgb8888;
  std::size_t paddingBytes = 64;  ///< after each row
  bool tellsPhase = true;         ///< when it is opened

  // To be changed meanwhile:

  bool isLost = false;  ///< every call fails; it cannot be opened
  int skips = 0;        ///< so many of the next flips end as kSkipped
  int holds = 0;        ///< so many of the next flips are missed: the surface is shown one later
  std::uint64_t sequenceJump = 0;  ///< added to its count of refreshes

  struct Shown {
    std::uint64_t sequence = 0;
    hal::TimePoint time;
    std::uint32_t firstPixel = 0;  ///< its bytes, little-endian
    std::uint64_t brightness = 0;  ///< the sum of red, green and blue of all pixels
    hal::FrameSize size;
  };
  std::vector<Shown> shown;
  int opened = 0;
  int reconfigured = 0;
  int lent = 0;  ///< surfaces that were acquired, and neither submitted nor released
};

/// A display behind the contract of hal::SurfaceOutput: surfaces in shared memory (memfd),
/// refreshes by an injected clock, at which the surfaces that are due and whose fences have
/// signalled are flipped. Needs no device.
class FakeDisplayOutput final : public hal::SurfaceOutput, private hal::SurfaceUnmapper {
 public:
  /// Both outlive it.
  FakeDisplayOutput(FakeDisplay& display, const hal::Clock& clock);
  ~FakeDisplayOutput() override;
  FakeDisplayOutput(const FakeDisplayOutput&) = delete;
  FakeDisplayOutput& operator=(const FakeDisplayOutput&) = delete;

  hal::OutputIdentity identity() const override { return {"fake_display", "fake"}; }
  hal::Result<hal::OutputFormat> start(const hal::OutputRequest& request) override;
  hal::Result<void> finish() override;
  hal::Result<hal::OutputFormat> reconfigure(const hal::OutputRequest& request) override;
  hal::Result<std::optional<hal::Surface>> acquire() override;
  hal::Result<hal::SurfaceMapping> map(const hal::Surface& surface) override;
  void release(const hal::Surface& surface) override;
  hal::Result<void> submit(const hal::Surface& surface, hal::Fence fence,
                           hal::TimePoint due) override;
  hal::Result<void> takeEvents(std::vector<hal::PresentationEvent>& events) override;
  std::optional<hal::TimePoint> nextEvent() const override;

 private:
  enum class State { kFree, kLent, kQueued, kOnScreen };
  struct Buffer {
    hal::Surface surface;
    std::uint8_t* memory = nullptr;
    std::size_t bytes = 0;
    State state = State::kFree;
    bool isMapped = false;
  };
  struct Queued {
    Buffer* buffer = nullptr;
    hal::Fence fence;
    hal::TimePoint due;
    hal::TimePoint submitted;
  };

  void unmap(hal::SurfaceId surface) override;
  Buffer& of(const hal::Surface& surface);
  hal::Result<void> makeBuffers(hal::FrameSize size);
  void destroyBuffers();
  hal::OutputFormat format() const;
  bool makeBuffer(hal::FrameSize size, std::uint32_t id);
  hal::TimePoint refreshAtOrAfter(hal::TimePoint time) const;
  bool isReady(const Queued& queued, hal::TimePoint refresh) const;
  void runTo(hal::TimePoint now);
  void flip(hal::TimePoint refresh);
  void end(Queued& queued, hal::PresentationEvent::Result result, hal::TimePoint time);

  FakeDisplay& display_;
  const hal::Clock& clock_;
  std::vector<Buffer> buffers_;
  std::deque<Queued> queue_;
  std::vector<hal::PresentationEvent> events_;
  Buffer* onScreen_ = nullptr;
  hal::TimePoint ranTo_;
};

}  // namespace pleinair::support
