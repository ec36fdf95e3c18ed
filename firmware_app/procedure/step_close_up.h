#pragma once

#include <glm/vec2.hpp>

#include "hal/image.h"

namespace pleinair::app {

/// The diameter of a close-up in a picture's height.
inline constexpr double kCloseUpShare = 0.44;

/// Sets the middle of `closeUp`, a circle of kCloseUpShare of its height, into a corner of a
/// picture of the same size, RGB8, and draws from where it is: round a place, in px, with its
/// radius. The corner is the one that is farthest from `away`, in px.
void setCloseUp(hal::Image& picture, const hal::Image& closeUp, const glm::dvec2& placePx,
                double radiusPx, const glm::dvec2& away);

}  // namespace pleinair::app
