#pragma once

#include <array>

#include "pipeline/scene/builtin/builtin_gearbox.h"

namespace pleinair::scene {

/// A gearbox's measures at its nominal size; metres.
struct GearboxPlan {
  /// What turns on one axis; y is along it, from the reader away.
  struct Shaft {
    double x = 0.0;
    double bearingBore = 0.0;  ///< radii
    double bearingOuter = 0.0;
    double seat = 0.0;  ///< where a gear sits
    double ballRadius = 0.0;
    int balls = 0;
    double radiansPerSecond = 0.0;
    double bossRadius() const { return bearingOuter + 0.007; }
  };
  std::array<GearboxGear, 4> gears;  ///< in this frame, with the axes' height
  std::array<double, 4> faceWidths{};
  std::array<double, 4> faceMiddles{};  ///< along y
  std::array<double, 4> seats{};        ///< bores' radii
  std::array<Shaft, 3> shafts;          ///< input, intermediate, output
  double axisHeight = 0.0;
  double left = 0.0;  ///< of the housing's inside, along x
  double right = 0.0;
  double length = 0.0;  ///< over the feet
};

inline constexpr double kHalfInside = 0.026;  ///< of the housing along y
inline constexpr double kWall = 0.007;
inline constexpr double kHalfOutside = kHalfInside + kWall;
inline constexpr double kHalfBoss = 0.040;  ///< to a bearing seat's outer face
inline constexpr double kFootLength = 0.020;
inline constexpr double kFootHeight = 0.009;
inline constexpr double kFloor = 0.006;
inline constexpr double kBearingNear = 0.0275;  ///< bearings, from the middle along y
inline constexpr double kBearingFar = 0.0385;

GearboxPlan gearboxPlan(const GearboxParameters& parameters);

}  // namespace pleinair::scene
