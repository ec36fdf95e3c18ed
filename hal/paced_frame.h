#pragma once

#include <optional>

#include "hal/camera.h"
#include "hal/clock.h"

namespace pleinair::hal {

/// Hands out the frame that a recorded or simulated camera holds ready, and leaves `pending` empty:
/// at once where frames are stepped, else at its capture time. CameraTimeout, and the frame stays,
/// where `deadline` comes before that time. Precondition: a frame is pending.
NextFrame takePaced(std::optional<CapturedFrame>& pending, Pacing pacing, Clock& clock,
                    TimePoint deadline);

}  // namespace pleinair::hal
