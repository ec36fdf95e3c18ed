#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "hal/clock.h"
#include "hal/repeated_reading.h"

namespace pleinair::app {

inline constexpr std::size_t kMostNoticeBytes = 1000;
inline constexpr int kMostNoticeLines = 8;

/// A message of the machine itself to people, such as that it is being updated: a file that
/// another program writes, shown over the painting for as long as it says something. Any thread.
class MachineNotice {
 public:
  static constexpr hal::Duration kInterval = std::chrono::seconds(1);

  /// `interval`: real time between two readings. The file need not exist.
  explicit MachineNotice(const std::filesystem::path& file, hal::Duration interval = kInterval);

  /// Empty: nothing.
  std::string text() const;

 private:
  hal::RepeatedReading<std::string> readings_;
};

/// The text of such a file: the beginning of a long one; '?' for bytes that are not UTF-8 and for
/// control characters. Empty where it cannot be read.
std::string readNotice(const std::filesystem::path& file);

}  // namespace pleinair::app
