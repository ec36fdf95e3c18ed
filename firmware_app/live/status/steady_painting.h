#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "firmware_app/live/status/presentation_watch.h"
#include "hal/clock.h"

namespace pleinair::app {

/// Judges whether people have seen paintings, one after the other, for a minute: what a new version
/// of a machine has to show before it is kept. Waiting pictures are no paintings. One thread.
class SteadyPainting {
 public:
  static constexpr hal::Duration kLasts = std::chrono::seconds(60);
  /// A longer pause begins the minute anew: as long as the watchdog's period of the units.
  static constexpr hal::Duration kLongestPause = std::chrono::seconds(10);

  /// To be called more often than a pause may last. Outputs that are excused, or that nobody reads,
  /// need not show anything, but without another one nothing is seen.
  void update(const std::vector<OutputProgress>& outputs, hal::TimePoint now);
  /// Once true, it stays so.
  bool hasLasted() const { return hasLasted_; }

 private:
  bool takePaintings(const std::vector<OutputProgress>& outputs);

  std::map<std::string, OutputProgress> before_;  ///< at the last progress
  std::optional<hal::TimePoint> since_;
  hal::TimePoint last_;
  bool hasLasted_ = false;
};

/// Tells the machine of it by a file. One thread.
class SteadyMark {
 public:
  /// `file`: made once, when paintings have lasted; empty: none.
  explicit SteadyMark(std::filesystem::path file) : file_(std::move(file)) {}

  /// As of SteadyPainting::update(). A file that cannot be made is reported in the log.
  void update(const std::vector<OutputProgress>& outputs, hal::TimePoint now);

 private:
  std::filesystem::path file_;
  SteadyPainting painting_;
};

}  // namespace pleinair::app
