#pragma once

#include <array>

#include "pipeline/scene/builtin/builtin_gearbox.h"

namespace pleinair::scene {

/// A gearbox's dimensions at its nominal size; metres.
struct GearboxPlan {
  /// Parts that turn on one axis; y is along it, away from the reader.
  struct Shaft {
    double x = 0.0;
    double bearingBore = 0.0;  ///< radii
    double bearingOuter = 0.0;
    double seat = 0.0;  ///< radius of a gear's seat
    double ballRadius = 0.0;
    int balls = 0;
    double radiansPerSecond = 0.0;
    double bossRadius() const { return bearingOuter + 0.007; }
  };
  std::array<GearboxGear, 4> gears;  ///< in this frame, at the height of the axes
  std::array<double, 4> faceWidths{};
  std::array<double, 4> faceMiddles{};  ///< along y
  std::array<double, 4> seats{};        ///< radii of the bores
  std::array<Shaft, 3> shafts;          ///< input, intermediate, output
  double axisHeight = 0.0;
  double left = 0.0;  ///< of the housing's interior, along x
  double right = 0.0;
  double length = 0.0;  ///< over the feet
};

inline constexpr double kHalfInside = 0.026;  ///< of the housing along y
inline constexpr double kWall = 0.007;
inline constexpr double kHalfOutside = kHalfInside + kWall;
inline constexpr double kHalfBoss = 0.040;  ///< to the outer face of a bearing seat
inline constexpr double kFootLength = 0.020;
inline constexpr double kFootHeight = 0.009;
inline constexpr double kFloor = 0.006;
inline constexpr double kBearingNear = 0.0275;  ///< distance of bearings from the centre, along y
inline constexpr double kBearingFar = 0.0385;

GearboxPlan gearboxPlan(const GearboxParameters& parameters);

}  // namespace pleinair::scene
