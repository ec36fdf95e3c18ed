#include "pipeline/overlay/other_machine.h"

#include <algorithm>

namespace pleinair::overlay {

bool OtherMachine::update(std::span<const int> unknown, bool isSeen, hal::TimePoint now) {
  if (isSeen) {
    for (const int id : unknown) note(id, now);
    return false;
  }
  return std::ranges::any_of(unknown, [&](int id) { return !isNeighbour(id, now); });
}

/// Of too many the one that was seen longest ago is forgotten.
void OtherMachine::note(int id, hal::TimePoint now) {
  auto place = std::ranges::find_if(
      neighbours_, [&](const std::optional<Neighbour>& each) { return each && each->id == id; });
  if (place == neighbours_.end()) {
    place = std::ranges::min_element(neighbours_, {}, [](const std::optional<Neighbour>& each) {
      return each ? each->together : hal::TimePoint::min();
    });
  }
  *place = Neighbour{.id = id, .together = now};
}

bool OtherMachine::isNeighbour(int id, hal::TimePoint now) const {
  return std::ranges::any_of(neighbours_, [&](const std::optional<Neighbour>& each) {
    return each && each->id == id && now - each->together <= kNeighbourFor;
  });
}

}  // namespace pleinair::overlay
