#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "pipeline/tracking/tag_detector.h"

namespace pleinair::tracking {

/// What was not used, by reason: of a frame, or sums over a Tracker's life.
struct TrackingCounters {
  DetectionCounters detection;
  std::uint32_t unknownTags = 0;        ///< ids that are not in the scene
  std::uint32_t mirroredTags = 0;       ///< tags of the scene that only the mirrored picture shows
  std::uint32_t smallTags = 0;          ///< too few pixels for a pose
  std::uint32_t degenerateTags = 0;     ///< corners that allow no pose
  std::uint32_t ambiguousTags = 0;      ///< nothing told the pose from its twin: used all the same
  std::uint32_t contradictingTags = 0;  ///< not where the other tags put them: used by themselves
};

/// What was counted after `before`.
TrackingCounters countedSince(const TrackingCounters& before, const TrackingCounters& now);

/// A reason for not using a tag, in a word, and how often it applied.
struct Rejection {
  std::string_view reason;
  std::uint32_t count = 0;
};
std::array<Rejection, 8> rejections(const TrackingCounters& counters);

}  // namespace pleinair::tracking
