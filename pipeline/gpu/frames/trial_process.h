#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "hal/error.h"

namespace pleinair::gpu {

/// This program, started once more with arguments of its own and with descriptors, for work in
/// which a driver may crash. Never waits; one thread.
class TrialProcess {
 public:
  /// The number of the first descriptor in the child; the others follow.
  static constexpr int kFirstDescriptor = 3;

  /// In the child: its arguments after the first two, where all of them are numbers.
  static std::optional<std::vector<std::uint64_t>> numbersOf(int argc, const char* const* argv);

  /// Starts it. The child has copies of the descriptors. `task`: what it tries, for errors: "draw
  /// into the display's memory".
  TrialProcess(std::vector<std::string> arguments, std::span<const int> descriptors,
               std::string task, const hal::Clock& clock);
  /// Ends it where it still runs; does not wait for its end.
  ~TrialProcess();
  TrialProcess(const TrialProcess&) = delete;
  TrialProcess& operator=(const TrialProcess&) = delete;

  /// Nothing while it runs; then its exit status. Error: kUnsupported (it has crashed, cannot be
  /// started, or takes too long).
  std::optional<hal::Result<int>> poll();

 private:
  hal::Result<int> resultOf(int status) const;

  int process_ = -1;  ///< −1: it could not be started, or has ended
  std::optional<hal::Result<int>> result_;
  std::string task_;
  const hal::Clock& clock_;
  hal::TimePoint began_;
};

}  // namespace pleinair::gpu
