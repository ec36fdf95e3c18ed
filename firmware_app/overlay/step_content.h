#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <string>

#include "hal/image.h"
#include "pipeline/overlay/overlay_content.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::app {

/// What a step of a procedure shows: the seam between whoever steps through it and the overlay.
struct StepShown {
  std::shared_ptr<const procedure::Procedure> procedure;
  std::size_t step = 0;            ///< index, or procedure::kEnd
  std::set<std::size_t> partsOff;  ///< when the step begins
  std::string language;
  std::string request;  ///< what is asked for, with the keys: "Page Down: done"
  std::string notice;   ///< what has gone wrong; empty: nothing
  bool isDone = false;  ///< the request is fulfilled
};

/// The overlay of a step, for pictures of the size `output`: looks and ghosts of its parts, arrows,
/// a label, the instruction, and the inset. `machine`: the model of the scene that the procedure is
/// about, with the procedure's parts (machineIn()). `inset`: that of the same step, if it was made
/// before; else it takes some 0.1 s. Any thread.
overlay::OverlayContent stepContent(const StepShown& shown, const scene::Model& machine,
                                    const std::filesystem::path& folder, hal::FrameSize output,
                                    const hal::Image* inset = nullptr);

}  // namespace pleinair::app
