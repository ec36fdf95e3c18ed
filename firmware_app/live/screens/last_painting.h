#pragma once

#include <filesystem>
#include <future>
#include <optional>

#include "hal/clock.h"
#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::app {

/// The folder for what the program keeps from run to run: $STATE_DIRECTORY (systemd), else
/// $XDG_STATE_HOME/pleinair, else $HOME/.local/state/pleinair; empty where none is set. It need not
/// exist.
std::filesystem::path stateFolder();

/// The folder that a service manager has made for this run: the first of $RUNTIME_DIRECTORY, which
/// may hold several, separated by colons; empty: there is none.
std::filesystem::path runtimeFolder();

/// The last painting of a run, for the first picture of the next one: a PNG file of at most
/// kMaxSide pixels a side. One thread; files are written in the background.
class LastPainting {
 public:
  static constexpr int kMaxSide = 1280;
  static constexpr hal::Duration kInterval = std::chrono::minutes(1);

  /// Keeps it in `folder`, which is made at need; an empty one: nowhere.
  explicit LastPainting(const std::filesystem::path& folder);

  /// The painting that was kept, as RGB8; nothing if there is none. Errors: those of reading;
  /// kInvalidInput (not a file of save()'s).
  hal::Result<std::optional<hal::Image>> read() const;

  /// Whether another one may be kept: a minute after the first call and after each save().
  bool isDue(hal::TimePoint now);
  /// As isDue(), for the end of the run: also within the first minute.
  bool isDueAtEnd(hal::TimePoint now) const;
  /// Begins to keep an RGBA8 picture. Precondition: isDue() or isDueAtEnd().
  void save(hal::Image painting, hal::TimePoint now);
  /// The error of the last save(), once; waits for it where `waits`.
  std::optional<hal::Error> takeFailure(bool waits = false);

 private:
  std::filesystem::path file_;
  std::optional<hal::TimePoint> began_;
  std::optional<hal::TimePoint> saved_;
  std::future<hal::Result<void>> saving_;
};

}  // namespace pleinair::app
