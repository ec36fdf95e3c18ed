#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/world/bench_tags.h"
#include "hal/cameras/synthetic/world/canvas.h"

namespace pleinair::hal::synthetic {

/// A tag on a white card, centred on `at`.
void paintTagCard(Canvas& canvas, const Placement& at, const BenchTag& tag);
/// The printed poster of a gear show; fills the canvas.
void paintPoster(Canvas& canvas);
/// A working drawing of a gearbox, 0.42 × 0.30 m.
void paintDrawing(Canvas& canvas, const Placement& at);
/// A sheet of notes of the given size with a small sketch.
void paintNotes(Canvas& canvas, const Placement& at, glm::vec2 half, std::uint32_t seed);
/// A sticky note, 76 mm.
void paintStickyNote(Canvas& canvas, const Placement& at, std::uint32_t srgb);
/// The ring-shaped stain of a mug.
void paintMugRing(Canvas& canvas, const Placement& at);

}  // namespace pleinair::hal::synthetic
