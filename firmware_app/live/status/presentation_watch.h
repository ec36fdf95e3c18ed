#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "pipeline/runtime/output/output_stage.h"

namespace pleinair::app {

/// What an output has shown so far.
struct OutputProgress {
  std::string name;
  std::uint64_t shown = 0;      ///< frames and waiting pictures that people have seen
  std::uint64_t paintings = 0;  ///< the frames among them
  std::uint64_t skipped = 0;    ///< frames that it had, but whose reader was too slow
  std::uint64_t submitted = 0;  ///< frames that it was to show
  std::uint64_t steps = 0;      ///< turns of its thread
  /// It cannot show anything now and says why: a display that is unplugged, off or not in front.
  bool isExcused = false;
  /// It always has something to show: frames, or waiting pictures, which are shown again and again.
  bool isScreen = false;
};

/// `isScreen`: the output shows waiting pictures.
OutputProgress progressOf(const runtime::OutputStage::Status& output, bool isScreen);

/// Judges whether a live painting still reaches its outputs, by what they have shown: that a loop
/// turns proves nothing. One thread.
class PresentationWatch {
 public:
  /// A camera that streams and a painter that paints nothing for so long: it hangs. Until then a
  /// waiting picture says that the next painting takes a while.
  static constexpr hal::Duration kPaintPatience = std::chrono::seconds(60);

  struct Seen {
    std::vector<OutputProgress> outputs;
    bool expectsPaintings = false;  ///< the camera streams, and there is a painter
    bool isTriggered = false;       ///< the camera sends a frame when something asks for one
    std::uint64_t arrived = 0;      ///< frames for the painter
    std::uint64_t painted = 0;
  };
  void update(Seen seen, hal::TimePoint now);

  /// Whether an output has shown a picture of any kind, or has had one that its reader did not
  /// take.
  bool hasShown() const;
  /// Whether since the last call that returned true every output has shown or skipped something,
  /// or had nothing to show or was excused while its thread turned, and painting does not hang.
  /// Where a camera waits for its trigger, there is nothing to show. False without outputs.
  bool takeProgress();

 private:
  bool hasAdvanced(const OutputProgress& output) const;

  Seen seen_;
  std::map<std::string, OutputProgress> before_;  ///< at the last progress
  std::uint64_t painted_ = 0;
  std::uint64_t arrivedBefore_ = 0;  ///< when it last painted
  bool waitsForTrigger_ = false;     ///< all that arrived is painted
  hal::TimePoint now_;
  hal::TimePoint paintedAt_;  ///< or when none was expected yet
};

}  // namespace pleinair::app
