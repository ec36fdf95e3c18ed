#pragma once

#include <string>

#include "pipeline/procedure/procedure.h"

namespace pleinair::app {

/// What a step asks for, with the keys: "Page Down: done". `typed`: the digits of a value so far.
std::string requestOf(const procedure::Procedure& procedure, std::size_t step,
                      const std::string& language, const std::string& typed);

/// What the end asks for: to sign off, where there is a record, and the way back.
std::string requestAtEnd(const std::string& language, bool isRecorded);

/// A step for a caption: number, title, warnings, text, torque. No request.
std::string captionOf(const procedure::Procedure& procedure, std::size_t step,
                      const std::string& language);

/// The keys that lead through a procedure, as LiveTuning::help() has its own.
std::string keyHelp(const std::string& language);

}  // namespace pleinair::app
