#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/clock.h"

namespace pleinair::app {

/// A progress line on standard error with the rate and the time left; shown only on a terminal.
class Progress {
 public:
  /// `total`: the number of frames, if known. The clock must outlive this object.
  Progress(std::string subcommand, std::optional<std::uint64_t> total, const hal::Clock& clock);
  /// Ends the line.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// After each frame; redraws a few times a second.
  void advance();
  /// Clears the line before other output; the next advance() redraws it.
  void interrupt();
  std::uint64_t frames() const { return done_; }
  /// The average rate since the start.
  double framesPerSecond() const;
  hal::Duration elapsed() const;

 private:
  void draw() const;

  std::string subcommand_;
  std::optional<std::uint64_t> total_;
  const hal::Clock& clock_;
  hal::TimePoint began_;
  hal::TimePoint drawn_;
  std::uint64_t done_ = 0;
  bool isTerminal_;
};

/// The text of the line: "painting 37/150  24.1 frames/s  5 s left".
std::string progressLine(const std::string& subcommand, std::uint64_t done,
                         std::optional<std::uint64_t> total, hal::Duration elapsed);

}  // namespace pleinair::app
