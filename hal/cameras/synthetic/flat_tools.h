#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/canvas.h"

namespace pleinair::hal::synthetic {

// Tools that lie or hang flat, with their shadows. Unless said otherwise they hang: their heads are
// towards +y.

/// A combination wrench, open end up.
void paintWrench(Canvas& canvas, const Placement& at, float lengthMetres);
/// A screwdriver, point down.
void paintScrewdriver(Canvas& canvas, const Placement& at, float lengthMetres, std::uint32_t srgb);
/// Pliers, closed, jaws up.
void paintPliers(Canvas& canvas, const Placement& at, std::uint32_t srgb);
/// A claw hammer, head up, 0.30 m.
void paintHammer(Canvas& canvas, const Placement& at);
/// A tenon saw, 0.34 m along x, its teeth down.
void paintSaw(Canvas& canvas, const Placement& at);
/// A carpenter's square: 0.24 m along x, 0.15 m along y.
void paintSquare(Canvas& canvas, const Placement& at);
/// A steel rule, 0.31 m along x.
void paintRule(Canvas& canvas, const Placement& at);
/// A steel washer.
void paintWasher(Canvas& canvas, const Placement& at, float radiusMetres);

}  // namespace pleinair::hal::synthetic
