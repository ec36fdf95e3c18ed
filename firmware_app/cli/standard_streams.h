#pragma once

#include <cstdio>
#include <string_view>

namespace pleinair::app {

/// Makes the standard streams harmless for the whole process; call once, first of all. A descriptor
/// 0 to 2 that the caller closed is opened on /dev/null, so that no file of ours takes its number
/// and gets the log. SIGPIPE is ignored: a reader of the log or of standard output that goes away
/// must not end the painting.
void prepareStandardStreams();

/// Writes `text` to a standard stream. A stream that takes nothing (closed, a full disk, a reader
/// that is gone) loses it: the log never ends the program. runCommandLine() checks standard output
/// once, at the end.
void writeText(std::FILE* stream, std::string_view text);

}  // namespace pleinair::app
