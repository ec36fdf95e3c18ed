#pragma once

#include <cstddef>
#include <cstdint>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "hal/cameras/synthetic/world/builder.h"

namespace pleinair::hal::synthetic {

// Positions of the larger objects, metres. World frame: origin on the bench's top, x to the right
// of the person at the bench, y towards the wall, z up. Some objects carry tags.

inline constexpr double kBenchHalfWidth = 1.15;
inline constexpr double kBenchFront = -0.46;
inline constexpr double kBenchBack = 0.44;
inline constexpr double kWallY = 0.45;
inline constexpr double kFloorZ = -0.88;

inline const glm::dmat4 kToolboxPose = uprightPose({-0.49, 0.20, 0}, 13);
inline constexpr glm::dvec3 kToolboxSize{0.40, 0.19, 0.165};
inline const glm::dmat4 kMachinePose = uprightPose({0.00, 0.29, 0.014}, -5);
inline constexpr glm::dvec3 kMachineSize{0.23, 0.17, 0.15};
inline const glm::dmat4 kBooksPose = uprightPose({-0.59, -0.10, 0}, 22);
inline constexpr double kBooksHeight = 0.056;
inline constexpr glm::dvec3 kWallSheetCentre{-0.205, kWallY - 0.002, 0.40};

/// Where a figure stands that crosses the room at `x`: in front of the bench, the first one facing
/// to the right, the second one to the left.
inline glm::dmat4 visitorPose(std::size_t figure, double x) {
  return figure == 0 ? uprightPose({x, -0.72, kFloorZ}) : uprightPose({x, -0.86, kFloorZ}, 180);
}

/// Plans the workbench and its room. The shape is the same for every seed; the wood varies with it.
Plan planWorkbench(std::uint32_t seed);

// The parts of the plan, one file each.
void buildRoom(Builder& builder);                       ///< room.cpp: walls, window, floor, shelf
void buildBench(Builder& builder, std::uint32_t seed);  ///< bench.cpp, with what lies flat on it
void buildMachines(Builder& builder);  ///< machines.cpp: toolbox, gear motor, vise, lamp
void buildClutter(Builder& builder);   ///< clutter.cpp: mug, books, bins, oil can, crate …
void buildArm(Builder& builder);       ///< machines.cpp: the reaching arm, in its own coordinates

}  // namespace pleinair::hal::synthetic
