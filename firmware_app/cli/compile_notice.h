#pragma once

#include <functional>

namespace pleinair::app {

/// For PainterOptions::isCancelled: answers whether a signal was received, and says in the log,
/// once in the process, that shaders are compiled, where that has gone on for a second since this
/// was called.
std::function<bool()> cancelledBySignal();

}  // namespace pleinair::app
