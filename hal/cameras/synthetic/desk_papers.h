#pragma once

#include <cstdint>

#include "hal/cameras/synthetic/desk_canvas.h"
#include "hal/cameras/synthetic/desk_tags.h"

namespace pleinair::hal::synthetic {

/// A white card with a tag on it, shadow included.
void paintTagCard(DeskCanvas& canvas, const DeskTag& tag);
/// A printed poster, 0.30 × 0.40 m, of bold coloured shapes.
void paintPoster(DeskCanvas& canvas, const Placement& at);
/// An A4 sheet with a heading, lines of writing and a drawing of a gear.
void paintWrittenSheet(DeskCanvas& canvas, const Placement& at, std::uint32_t seed);
/// A sheet of colour samples: washes side by side.
void paintColourChart(DeskCanvas& canvas, const Placement& at);
/// A sticky note, 76 mm, with a scribble.
void paintStickyNote(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb);
/// A closed notebook with a cloth spine and an elastic band.
void paintNotebook(DeskCanvas& canvas, const Placement& at, std::uint32_t srgb);

}  // namespace pleinair::hal::synthetic
