#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/outputs/display/card.h"

namespace pleinair::support {

struct FakeMode {
  hal::FrameSize size{64, 48};
  double hertz = 60.0;
  bool isPreferred = false;
  bool isInterlaced = false;
  bool isRefused = false;  ///< by commits
};

struct FakeConnector {
  std::string name = "HDMI-A-1";
  bool isConnected = true;
  std::vector<FakeMode> modes{{.size = {64, 48}, .hertz = 60.0, .isPreferred = true}};
  std::uint32_t crtcs = ~std::uint32_t{0};
};

/// A graphics card, as its driver presents it, and what goes wrong with it.
struct FakeCardSpec {
  std::string node = "/dev/dri/card0";
  std::vector<FakeConnector> connectors{FakeConnector{}};
  int crtcs = 2;
  int planesPerCrtc = 1;  ///< each of its own CRTC only
  bool hasVblank = true;
  bool exportsDmaBufs = true;
  std::size_t rowPadding = 64;
  std::size_t memoryBytes = ~std::size_t{0};  ///< for buffers
  bool hasConsole = true;                     ///< CRTC 0 shows one before
  /// The layouts that its GPU's buffers can have; empty: it has no GPU.
  std::vector<std::uint64_t> gpuModifiers;
  std::vector<std::uint64_t> planeModifiers;  ///< that its planes list; empty: none
  bool waitsForFences = false;                ///< has IN_FENCE_FD

  // To be changed meanwhile:

  bool isGone = false;             ///< unplugged: every call fails
  bool hasOtherMaster = false;     ///< commits are refused
  int busyFlips = 0;               ///< so many of the next flips are EBUSY
  bool losesFlips = false;         ///< flips are taken, but no event comes
  int memorylessFlips = 0;         ///< so many of the next flips are ENOMEM
  bool refusesGpuTests = false;    ///< TEST_ONLY of a GPU's buffer is EINVAL
  bool refusesGpuFlips = false;    ///< flips to a GPU's buffer are EINVAL, tests are not
  bool refusesPanning = false;     ///< flips that change SRC_X or SRC_Y are EINVAL
  bool garblesGpuBuffers = false;  ///< what is read of one is not what was drawn

  // What is seen of CRTC 0:

  bool isOn = false;  ///< not switched off (ACTIVE)
  int panX = 0;       ///< the place of its framebuffer that it shows, in px
  int panY = 0;
  bool showsConsole = false;                  ///< and no picture of ours
  std::function<std::uint32_t()> firstPixel;  ///< of the picture that it has, also while it is off
  std::function<std::uint32_t(int x, int y)> pixel;  ///< the same, of any of its framebuffer
};

/// A machine with fake cards, as strict about masters, properties, sizes and pending flips as the
/// kernel. Flips take place at refreshes of `clock`, whole periods after its start; without vblank,
/// at once. One thread at a time.
class FakeCards final : public hal::display::Cards {
 public:
  explicit FakeCards(const hal::Clock& clock) : clock_(clock) {}

  FakeCardSpec& add(FakeCardSpec spec = {});

  std::vector<std::string> nodes() override;
  hal::Result<std::unique_ptr<hal::display::Card>> open(const std::string& node) override;
  std::optional<hal::Duration> timeOfDay() override { return localTime; }
  hal::Duration timeSuspended() override { return suspended; }

  std::optional<hal::Duration> localTime = std::chrono::hours(12);
  hal::Duration suspended{0};

  // What was seen of the cards. Of the only one, or of the card at `node`.

  struct Shown {
    hal::display::ObjectId crtc = 0;
    std::uint64_t sequence = 0;
    hal::TimePoint time;
    std::uint32_t firstPixel = 0;  ///< its bytes, little-endian
  };
  std::vector<Shown> shown;
  int modesets = 0;
  int tests = 0;
  int flips = 0;
  int restores = 0;
  int switchedOff = 0;                           ///< CRTCs, by ACTIVE
  std::vector<std::size_t> changesOfFlips;       ///< how many properties each changed
  int buffers = 0;                               ///< that exist now
  int gpuBuffers = 0;                            ///< that exist now
  int flipsWithFence = 0;                        ///< that the card waits with
  std::vector<std::uint64_t> gpuModifiersAsked;  ///< of the last buffer of a GPU
  int blobs = 0;                                 ///< that exist now
  int openCards = 0;

 private:
  friend class FakeCard;
  const hal::Clock& clock_;
  std::map<std::string, FakeCardSpec> specs_;
};

}  // namespace pleinair::support
