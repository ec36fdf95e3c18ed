#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/builder.h"

namespace pleinair::hal::synthetic {

/// The workbench in its room. The shape is the same for every seed; the wood is not.
Plan planWorkbench(std::uint32_t seed);

// Its parts, in one file each.
void buildRoom(Builder& builder);                       ///< room.cpp: walls, window, floor, shelf
void buildBench(Builder& builder, std::uint32_t seed);  ///< bench.cpp, with what lies flat on it
void buildMachines(Builder& builder);  ///< machines.cpp: toolbox, gear motor, vise, lamp
void buildClutter(Builder& builder);   ///< clutter.cpp: mug, books, bins, oil can, crate …
void buildArm(Builder& builder);       ///< arm.cpp: what reaches in, in its own coordinates

}  // namespace pleinair::hal::synthetic
