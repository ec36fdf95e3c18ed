#pragma once

#include <memory>

#include "hal/cameras/synthetic/synthetic_camera.h"
#include "pipeline/measure/input/true_motion.h"

namespace pleinair::measure {

/// The true motion of a synthetic camera's frames, from its poses and the geometry of its world.
std::unique_ptr<TrueMotion> workbenchMotion(const hal::SyntheticOptions& options);
/// The true masks of movers in these frames: the arm and the figures.
std::unique_ptr<TrueMovers> workbenchMovers(const hal::SyntheticOptions& options);

}  // namespace pleinair::measure
