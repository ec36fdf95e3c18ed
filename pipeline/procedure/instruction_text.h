#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "config/config_error.h"
#include "pipeline/procedure/procedure.h"

namespace pleinair::procedure {

/// The Markdown file of one language:
///
///     # Title of the procedure
///     ## step_id: Title of the step
///     Text, with *emphasis* and lists.
///     ![caption](picture.png)
///     ? The question of the step's check
struct InstructionText {
  std::string title;
  std::map<std::string, StepText> steps;  ///< by id
  std::map<std::string, int> lines;       ///< of the headings, by id
  /// Names of all pictures, with the line of each.
  std::vector<std::pair<std::string, int>> pictures;
};

/// Reads it. `file` names it in messages; `ids`: the procedure's steps. Mistakes (a heading of no
/// step, two of one step, a missing title) are added to `faults`.
InstructionText readInstructionText(std::string_view markdown, const std::string& file,
                                    std::span<const std::string> ids,
                                    std::vector<config::ConfigError>& faults);

}  // namespace pleinair::procedure
