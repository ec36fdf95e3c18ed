#pragma once

#include <span>

#include <glm/mat3x3.hpp>

#include "hal/image.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/scene/models/model.h"

namespace pleinair::app {

/// A model drawn by the processor: parts in focus in the reserved colour, hatched where others hide
/// them, the others pale; from the side that shows most of them. RGBA8, opaque, with a frame.
/// `looks`: per part; hidden ones are left out. `together`: parts that are drawn in focus although
/// they are off (ghosts). `arrows` are drawn over it. Parts are at rest; skins and morph targets
/// are not looked at. `uprightFromModel` turns the model so that its z is up. Some 0.1 s for 60,000
/// triangles. Any thread.
hal::Image modelPicture(const scene::Model& model, std::span<const overlay::PartLook> looks,
                        std::span<const overlay::Ghost> together,
                        std::span<const overlay::Arrow> arrows, hal::FrameSize size,
                        const glm::dmat3& uprightFromModel = glm::dmat3(1.0));

}  // namespace pleinair::app
