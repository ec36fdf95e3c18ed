#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <set>
#include <stop_token>
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
  std::string request;     ///< what is asked for, with the keys: "Page Down: done"
  std::string notice;      ///< what has gone wrong; empty: nothing
  bool isDone = false;     ///< the request is fulfilled
  bool isAborted = false;  ///< at kEnd: the record was signed off before the end
};

/// The overlay of a step, for pictures of the size `output`: looks and ghosts of its parts, arrows,
/// a label, the instruction, and the inset `inset`: stepInset(), or blankInset() until that is
/// made. A movie is not in it, but its place in the panel (0 × 0: none). `machine`: the model of
/// the scene that the procedure is about, with the procedure's parts (machineIn()). Any thread.
overlay::OverlayContent stepContent(const StepShown& shown, const scene::Model& machine,
                                    const std::filesystem::path& folder, hal::FrameSize output,
                                    hal::Image inset);

/// The step drawn from the model, without a camera, for pictures that are so wide: RGBA8. It takes
/// some 0.1 s, many times what all else of the content does. Any thread.
hal::Image stepInset(const StepShown& shown, const scene::Model& machine, int outputWidth);
/// The step's movie for its place in a content of the step; where it cannot be read a text that
/// says so, and a warning in the log. Null where the step has none, or where `stop` was requested.
/// It may take longer than the inset. Any thread.
std::shared_ptr<const overlay::PanelMovie> stepMovie(const StepShown& shown,
                                                     const std::filesystem::path& folder,
                                                     const overlay::MoviePlace& place,
                                                     const std::stop_token& stop = {});
/// Nothing, in the size of stepInset(): its place is kept clear.
hal::Image blankInset(int outputWidth);

}  // namespace pleinair::app
