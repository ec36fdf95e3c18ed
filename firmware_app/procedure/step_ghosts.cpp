#include "firmware_app/procedure/step_ghosts.h"

#include <algorithm>

#include "pipeline/overlay/part_shape.h"

namespace pleinair::app {
namespace {

using procedure::Step;

overlay::PartShape shapeIn(const Step& step, const scene::Model& machine, std::size_t part) {
  return overlay::alongAxis(overlay::shapeOf(machine, part), step.axis);
}

/// How far parts are shown from their place: all of a step alike, so that they keep their order.
double apartMetres(const Step& step, const scene::Model& machine,
                   const std::vector<std::size_t>& parts) {
  const double whole = scene::boundingSphere(machine).radiusMetres;
  double longest = 0.0;
  for (const std::size_t each : parts) {
    longest = std::max(longest, shapeIn(step, machine, each).halfLength);
  }
  return std::clamp(2.4 * longest, 0.18 * whole, 0.55 * whole);
}

void addMoving(const Step& step, const scene::Model& machine, const std::vector<std::size_t>& parts,
               bool comesHome, std::vector<overlay::Ghost>& ghosts) {
  if (parts.empty()) return;
  const double apart = apartMetres(step, machine, parts);
  for (const std::size_t each : parts) {
    ghosts.push_back({.part = each,
                      .apartMetres = apart * shapeIn(step, machine, each).axis,
                      .comesHome = comesHome});
  }
}

}  // namespace

std::vector<overlay::Ghost> ghostsOf(const Step& step, const scene::Model& machine,
                                     double unitMetres) {
  std::vector<overlay::Ghost> ghosts;
  for (const auto& [part, view] : step.views) {
    if (view == procedure::PartView::kGhost) ghosts.push_back({.part = part});
  }
  for (const auto& [part, metres] : step.apart) {
    ghosts.push_back({.part = part,
                      .apartMetres = metres / unitMetres * shapeIn(step, machine, part).axis,
                      .stays = true});
  }
  if (step.motion != procedure::Motion::kNone && step.apart.empty()) {
    addMoving(step, machine, step.removes, false, ghosts);
    addMoving(step, machine, step.fits, true, ghosts);
  }
  return ghosts;
}

bool isStill(const overlay::Ghost& ghost) {
  return ghost.stays || ghost.apartMetres == glm::dvec3(0.0);
}

}  // namespace pleinair::app
