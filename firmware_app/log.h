#pragma once

namespace pleinair::app {

/// Warnings and notes go to standard error, one a line: "pleinair: warning: …".
void logToStandardError();

}  // namespace pleinair::app
