#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pleinair::hal {

/// The scripted scenes of the synthetic camera.
enum class SyntheticShot {
  kWalkaround,  ///< handheld, around the bench
  kPan,         ///< on a tripod, panning from side to side
  kDolly,       ///< on a rail, towards the bench and back
  kRoll,        ///< rotating about the optical axis
  kStill,       ///< static
  kOccluder,    ///< an arm reaches in and out again, before a handheld camera that stays in place
  kCut,         ///< handheld, with a hard cut every two seconds
  kVisitors,    ///< on a tripod, far back; persons cross the room, and one of them stops
  kLights,      ///< static; a spotlight goes on and off, and the exposure falls and recovers
  kHand,        ///< static; the arm reaches in slowly, rests, goes on, and withdraws
  kCrossing,    ///< as kVisitors; two persons come from both sides and pass each other
  kPortrait,    ///< static; a person comes close before a bare wall, sways and gestures
};

std::string_view toString(SyntheticShot shot);
/// The shot of this name, if there is one.
std::optional<SyntheticShot> syntheticShotNamed(std::string_view name);
/// All names, in the enumeration's order.
std::span<const std::string_view> syntheticShots();
/// All names as text: "walkaround, pan, …"
std::string syntheticShotNames();

}  // namespace pleinair::hal
