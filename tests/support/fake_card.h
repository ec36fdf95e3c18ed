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

  // To be changed meanwhile:

  bool isGone = false;          ///< unplugged: every call fails
  bool hasOtherMaster = false;  ///< commits are refused
  int busyFlips = 0;            ///< so many of the next flips are EBUSY
  bool losesFlips = false;      ///< flips are taken, but no event comes
  int memorylessFlips = 0;      ///< so many of the next flips are ENOMEM

  // What is seen of CRTC 0:

  bool isOn = false;                          ///< not switched off (ACTIVE)
  bool showsConsole = false;                  ///< and no picture of ours
  std::function<std::uint32_t()> firstPixel;  ///< of the picture that it has, also while it is off
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
  hal::Duration timeOfDay() override { return localTime; }
  hal::Duration timeSuspended() override { return suspended; }

  hal::Duration localTime = std::chrono::hours(12);
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
  int switchedOff = 0;                      ///< CRTCs, by ACTIVE
  std::vector<std::size_t> changesOfFlips;  ///< how many properties each changed
  int buffers = 0;                          ///< that exist now
  int blobs = 0;                            ///< that exist now
  int openCards = 0;

 private:
  friend class FakeCard;
  const hal::Clock& clock_;
  std::map<std::string, FakeCardSpec> specs_;
};

}  // namespace pleinair::support
