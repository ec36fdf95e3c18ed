#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/error.h"
#include "hal/numbered_path.h"

namespace pleinair::hal::recording {

/// Whether the name ends as pictures do (.png, .JPG …).
bool isPictureName(const std::filesystem::path& path);

/// Natural order: runs of digits compare as numbers ("a2" before "a10").
bool naturallyLess(std::string_view a, std::string_view b);

/// The pictures directly in a folder, in natural order; hidden files are ignored. Errors:
/// kInvalidInput (none there), kPermissionDenied, kIo.
Result<std::vector<std::filesystem::path>> picturesIn(const std::filesystem::path& folder);

/// The files of a pattern, from the smallest number up to the first gap. Errors: kNotFound (none),
/// kPermissionDenied, kIo.
Result<std::vector<std::filesystem::path>> picturesOf(const NumberedPath& pattern,
                                                      std::string_view patternText);

}  // namespace pleinair::hal::recording
