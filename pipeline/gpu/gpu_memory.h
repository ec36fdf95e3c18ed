#pragma once

#include <string_view>

namespace pleinair::gpu {

/// Throws hal::Failure (kUnsupported) "the GPU has no memory for `what`" if GL ran out of
/// memory since it was last asked. Called after what allocates: it waits for a driver's thread.
void checkMemory(std::string_view what);

/// The error itself.
[[noreturn]] void throwOutOfMemory(std::string_view what);

}  // namespace pleinair::gpu
