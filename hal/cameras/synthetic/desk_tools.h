#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/desk_canvas.h"

namespace pleinair::hal::synthetic {

/// A green cutting mat, 0.46 × 0.32 m, with a centimetre grid.
void paintCuttingMat(DeskCanvas& canvas, const Placement& at);
/// A wooden rule, 0.31 m, in millimetres.
void paintRule(DeskCanvas& canvas, const Placement& at);
/// A sharpened pencil, 0.17 m, its point towards +x.
void paintPencil(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb);
/// A round brush, 0.21 m, its tip towards +x, dipped in a colour.
void paintBrush(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb);
/// A flat tin of twelve pans of watercolour, 0.22 × 0.09 m.
void paintPaintBox(DeskCanvas& canvas, const Placement& at);
/// A coin of the given metal.
void paintCoin(DeskCanvas& canvas, const Placement& at, float radiusMetres, std::uint32_t srgb);
/// A steel washer.
void paintWasher(DeskCanvas& canvas, const Placement& at, float radiusMetres);
/// The ring that a cup left.
void paintCupRing(DeskCanvas& canvas, const Placement& at);
/// A leaf, 0.11 m, its stalk towards −x.
void paintLeaf(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb);

}  // namespace pleinair::hal::synthetic
