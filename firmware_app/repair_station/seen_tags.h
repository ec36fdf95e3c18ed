#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include <glm/mat4x4.hpp>

#include "firmware_app/repair_station/command_cards.h"
#include "hal/clock.h"
#include "hal/image.h"
#include "pipeline/record/record_entry.h"
#include "pipeline/scene/description/scene.h"
#include "pipeline/tracking/pose/tracker.h"

namespace pleinair::app {

/// What the tracking of a frame says, for the main thread. A value without memory of its own.
struct SeenTags {
  static constexpr std::size_t kMaxTags = 32;
  struct Pose {
    tracking::PoseSource source = tracking::PoseSource::kSeen;
    std::optional<double> rmsPx;  ///< of a single tag it is not known
    double sigmaMetres = 0.0;     ///< predicted, of the place, over all axes
  };

  hal::TimePoint captured;
  std::array<ShownTag, kMaxTags> shown{};  ///< those that the frame shows, not the carried ones
  std::size_t shownCount = 0;
  std::array<int, kMaxTags> posedIds{};
  std::array<Pose, kMaxTags> poses{};  ///< of posedIds
  std::size_t poseCount = 0;
  std::optional<Pose> world;

  std::span<const ShownTag> tags() const { return {shown.data(), shownCount}; }
};

/// `frame`: the size that the tags' corners are in px of. Tags beyond kMaxTags are left out.
SeenTags seenTagsOf(const tracking::TrackingResult& tracking, hal::FrameSize frame,
                    hal::TimePoint captured);

/// Where a scene places the machine of a procedure: of several tag worlds, such as the machine and
/// a tool board, the one that a record's pose quality is about.
struct MachinePlace {
  bool isKnown = false;      ///< the scene has the machine
  std::optional<int> tagId;  ///< nothing: the world
  glm::dmat4 attachFromModel{1.0};
};

/// Of the scene's model that is the machine.
MachinePlace machinePlaceOf(const scene::SceneModel& machine);

/// Where the machine was in a frame that shows its tags; nothing where it is carried or not seen.
std::optional<glm::dmat4> cameraFromMachine(const MachinePlace& place,
                                            const tracking::TrackingResult& tracking);

/// How well the machine was located in a frame. Nothing where the scene does not place it.
std::optional<record::PoseQuality> poseQualityOf(const MachinePlace& place, const SeenTags& seen);

}  // namespace pleinair::app
