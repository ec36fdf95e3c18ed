#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace pleinair::hal {

/// What happens in front of the synthetic camera.
enum class SyntheticShot {
  kWalkaround,  ///< held by hand, around the bench
  kPan,         ///< on a tripod, turning from side to side
  kDolly,       ///< on a rail, towards the bench and back
  kRoll,        ///< turning about its own axis
  kStill,       ///< nothing moves
  kOccluder,    ///< an arm reaches in and out again, before a camera that is held still by hand
  kCut,         ///< held by hand, with a hard change of view every two seconds
};

std::string_view toString(SyntheticShot shot);
/// Nothing where no shot has the name.
std::optional<SyntheticShot> syntheticShotNamed(std::string_view name);
/// In the enumeration's order.
std::span<const std::string_view> syntheticShots();
/// "walkaround, pan, …"
std::string syntheticShotNames();

}  // namespace pleinair::hal
