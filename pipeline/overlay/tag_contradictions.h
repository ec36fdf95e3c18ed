#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "pipeline/scene/description/scene.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::overlay {

/// Knows which tags of a world are not to be trusted: a tag that was printed at another size, was
/// moved, or is that of another machine does not fit those beside it. Alone it looks as good as any
/// other, so it is remembered until it is seen to fit. Of two tags that contradict each other
/// neither is believed; of more, those that agree are. Allocates when it is made; one thread.
class TagContradictions {
 public:
  /// `scene` outlives this. `machine`: index of its model.
  TagContradictions(const scene::Scene& scene, std::size_t machine);

  /// Takes a frame. Whether only doubtful tags place the machine; where none is seen, as before.
  bool update(const tracking::TrackingResult& tracked);

 private:
  const scene::Scene& scene_;
  std::optional<int> machineTag_;
  bool isPlacedByWorld_;
  std::vector<std::uint8_t> isDoubtful_;     ///< per tag of the scene, from frame to frame
  std::vector<std::size_t> agree_, differ_;  ///< in the frame; members so that memory is reused
  bool isMachineDoubtful_ = false;
};

}  // namespace pleinair::overlay
