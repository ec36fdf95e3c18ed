#pragma once

#include <string>

#include "firmware_app/live/status/presentation_watch.h"
#include "firmware_app/service_manager/service_manager.h"
#include "hal/clock.h"

namespace pleinair::app {

/// Reports a live painting to the service manager: READY with the first picture of any kind,
/// WATCHDOG as long as pictures are shown (PresentationWatch), STATUS, RELOADING and STOPPING.
/// Main thread.
class ServiceReporter {
 public:
  /// The manager outlives this; it need not be there.
  explicit ServiceReporter(const ServiceManager& manager);

  /// Whether update() is to be called.
  bool isDue(hal::TimePoint now) const;
  /// `status`: one line for people.
  void update(PresentationWatch::Seen seen, const std::string& status, hal::TimePoint now);

  void reloading(hal::TimePoint now) const;
  /// `problem`: why the last values stay in force; empty: the new ones are. It stays in STATUS
  /// until the next reload.
  void reloaded(std::string problem);
  void stopping() const { manager_.notify("STOPPING=1"); }

  /// So often a waiting picture has to be shown again for the watchdog; zero: it need not.
  hal::Duration renewal() const;

 private:
  void sendStatus(const std::string& status, hal::TimePoint now);

  const ServiceManager& manager_;
  PresentationWatch watch_;
  bool isReady_ = false;
  std::string problem_;
  std::string status_;
  hal::TimePoint updatedAt_;
  hal::TimePoint fedAt_;
  hal::TimePoint statusAt_;
};

}  // namespace pleinair::app
