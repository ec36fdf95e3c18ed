#pragma once

#include <ctime>
#include <filesystem>

#include "hal/error.h"
#include "hal/image.h"

namespace pleinair::app {

/// Writes RGB8 as a new PNG "pleinair-YYYYmmdd-HHMMSS.png" (of `time`, in local time; "-2" and so
/// on where that exists) in `folder`, and gives its path. What is there is never replaced, and
/// nothing partial stands under the name. Errors: kNotFound (no such folder), kPermissionDenied,
/// kNoSpace, kIo.
hal::Result<std::filesystem::path> saveStill(const std::filesystem::path& folder,
                                             const hal::ImageView& picture, std::time_t time);

}  // namespace pleinair::app
