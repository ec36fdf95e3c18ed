#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>

#include "hal/clock.h"

namespace pleinair::overlay {

/// Tells tags of another machine from those that merely stand beside this one. Of tags that the
/// scene does not know, one that was in view together with a tag of the machine lately is a
/// neighbour: it stays in view when a hand covers the machine's. Another one is seen instead of the
/// machine. Allocates nothing; one thread.
class OtherMachine {
 public:
  static constexpr hal::Duration kNeighbourFor = std::chrono::seconds(10);
  static constexpr std::size_t kMostNeighbours = 32;

  /// Whether a tag of another machine is seen. `unknown`: ids of tags in this frame that the scene
  /// does not know; `isSeen`: whether a tag of the machine is in it.
  bool update(std::span<const int> unknown, bool isSeen, hal::TimePoint now);
  /// As after a cut.
  void reset() { neighbours_ = {}; }

 private:
  struct Neighbour {
    int id = 0;
    hal::TimePoint together;
  };
  void note(int id, hal::TimePoint now);
  bool isNeighbour(int id, hal::TimePoint now) const;

  std::array<std::optional<Neighbour>, kMostNeighbours> neighbours_{};
};

}  // namespace pleinair::overlay
