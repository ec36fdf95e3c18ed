#pragma once

#include <string>
#include <string_view>

#include "hal/error.h"

namespace pleinair::procedure {

/// A command to a procedure that is carried out, from a pedal, a card, another program.
enum class StepCommandKind {
  kNext,  ///< ends the step; takes the photo of a step that asks for one; answers no question
  kBack,  ///< to the step before
  kYes,   ///< answers a question, or says that a comparison passes
  kNo,
  kUncertain,  ///< of a comparison
  kPhoto,      ///< takes a still; ends a step that asks for one
  kValue,      ///< a measured value, in the check's unit
  kRaw,        ///< shows the camera's picture, and the painting again
  kOperator,   ///< somebody else goes on
  kSignOff,    ///< at the end only
  kAbort,      ///< signs the record off before the end
};

struct StepCommand {
  StepCommandKind kind = StepCommandKind::kNext;
  double value = 0.0;        ///< of kValue
  std::string operatorName;  ///< of kOperator
  friend bool operator==(const StepCommand&, const StepCommand&) = default;
};

/// Reads "next", "back", "yes", "no", "uncertain", "photo", "value 1.5", "raw", "operator J.
/// Müller", "sign_off", "abort". The error (kInvalidArgument) lists them. At most 200 bytes of
/// UTF-8 without control characters.
hal::Result<StepCommand> parseStepCommand(std::string_view text);
/// As parseStepCommand() reads it.
std::string textOf(const StepCommand& command);
/// "next, back, … value NUMBER, … operator NAME": for messages and documents.
std::string stepCommandForms();

}  // namespace pleinair::procedure
