#pragma once

#include <filesystem>
#include <string>

#include "hal/error.h"
#include "hal/image.h"
#include "pipeline/inspection/part_inspection.h"
#include "pipeline/inspection/template_file.h"
#include "pipeline/procedure/notices.h"
#include "pipeline/procedure/procedure.h"
#include "pipeline/procedure/stepper.h"

namespace pleinair::app {

/// Whether the template of a step's check says where it was taken. Otherwise people compare by eye.
bool comparesByItself(const std::filesystem::path& folder, const procedure::Check& check);

/// Compares a still with the template of a step, in a procedure's folder. `place`: where the
/// machine is in the still. Errors: those of the template's files, and kInvalidInput where they are
/// for another size. Some 0.1 s. Precondition: the step has a comparison, and comparesByItself().
hal::Result<inspection::Inspection> compareStill(const procedure::Procedure& procedure,
                                                 const procedure::Step& step,
                                                 const std::filesystem::path& folder,
                                                 const hal::ImageView& still,
                                                 const inspection::TemplatePose& place);

/// A verdict as an answer.
procedure::Comparison answerOf(inspection::Verdict verdict);

/// Why a comparison is uncertain, and what would help.
std::string reasonText(const inspection::Inspection& inspection, const procedure::Notices& notices);

}  // namespace pleinair::app
