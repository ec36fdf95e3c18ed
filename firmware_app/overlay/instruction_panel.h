#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "firmware_app/overlay/step_content.h"
#include "hal/image.h"

namespace pleinair::app {

struct InstructionPanel {
  hal::Image image;
  std::optional<overlay::MoviePlace> movie;  ///< where the step has one; dark in the image
};

/// The instruction of a step as a strip as wide as the output: warnings, number and title, text,
/// movie or picture, tools, torque, and what is asked for. Not higher than two fifths of the
/// output: a long text is set in smaller letters, by up to 30 %, and then cut. Any thread; all as
/// OverlayContent has its pictures.
InstructionPanel instructionPanel(const StepShown& shown, const std::filesystem::path& folder,
                                  hal::FrameSize output);
/// The number of a step, and a short text beside it.
hal::Image stepMarker(const std::string& number, const std::string& text, int outputWidth);
/// Why nothing is shown on the machine.
hal::Image doubtBadge(const std::string& text, int outputWidth);

}  // namespace pleinair::app
