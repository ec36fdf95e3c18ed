#include "pipeline/tracking/tracking_counters.h"

namespace pleinair::tracking {

TrackingCounters countedSince(const TrackingCounters& before, const TrackingCounters& now) {
  return {.detection = {.accepted = now.detection.accepted - before.detection.accepted,
                        .rejectedMargin =
                            now.detection.rejectedMargin - before.detection.rejectedMargin,
                        .rejectedDuplicate =
                            now.detection.rejectedDuplicate - before.detection.rejectedDuplicate,
                        .skippedSmallPicture = now.detection.skippedSmallPicture -
                                               before.detection.skippedSmallPicture},
          .unknownTags = now.unknownTags - before.unknownTags,
          .mirroredTags = now.mirroredTags - before.mirroredTags,
          .smallTags = now.smallTags - before.smallTags,
          .degenerateTags = now.degenerateTags - before.degenerateTags,
          .ambiguousTags = now.ambiguousTags - before.ambiguousTags,
          .contradictingTags = now.contradictingTags - before.contradictingTags};
}

std::array<Rejection, 8> rejections(const TrackingCounters& counters) {
  return {{{"faint", counters.detection.rejectedMargin},
           {"duplicate", counters.detection.rejectedDuplicate},
           {"unknown", counters.unknownTags},
           {"mirrored", counters.mirroredTags},
           {"small", counters.smallTags},
           {"degenerate", counters.degenerateTags},
           {"ambiguous", counters.ambiguousTags},
           {"contradicting", counters.contradictingTags}}};
}

}  // namespace pleinair::tracking
