#pragma once

namespace pleinair::gpu {

/// Ends the displays that contexts of our own were made on; their drivers write what they still
/// have for their shader cache, which the end of the process would lose. For the end of a program:
/// no EglContext may exist, and no other code may use the displays. Any thread.
void terminateDisplays();

}  // namespace pleinair::gpu
