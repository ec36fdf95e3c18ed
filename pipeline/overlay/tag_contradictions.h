#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "pipeline/scene/description/scene.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::overlay {

/// Which tags of a scene did not fit when they were last seen beside others. Alone such a tag looks
/// as good as any other, so this outlives painters, which are made anew for another style or after
/// a lost GPU. One thread at a time.
struct DoubtfulTags {
  std::vector<std::uint8_t> isDoubtful;  ///< per tag of the scene; of another number: forgotten
  bool isMachineDoubtful = false;        ///< only such tags placed the machine, when it was placed
};

/// Knows which tags of a world are not to be trusted: a tag that was printed at another size, was
/// moved, or is that of another machine does not fit those beside it. Alone it looks as good as any
/// other, so it is remembered until it is seen to fit. Of two tags that contradict each other
/// neither is believed; of more, those that agree are. Allocates when it is made; one thread.
class TagContradictions {
 public:
  /// `scene` outlives this. `machine`: index of its model. `kept`: what is known of the scene's
  /// tags so far; null: nothing.
  TagContradictions(const scene::Scene& scene, std::size_t machine,
                    std::shared_ptr<DoubtfulTags> kept = nullptr);

  /// Takes a frame. Whether only doubtful tags place the machine; where none is seen, as before.
  bool update(const tracking::TrackingResult& tracked);

 private:
  const scene::Scene& scene_;
  std::optional<int> machineTag_;
  bool isPlacedByWorld_;
  std::shared_ptr<DoubtfulTags> known_;
  std::vector<std::size_t> agree_, differ_;  ///< in the frame; members so that memory is reused
};

}  // namespace pleinair::overlay
